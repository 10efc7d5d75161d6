#include "output/checkpoint.h"

#include <unistd.h>

#include "core/error.h"

namespace sphgeo {

FoundCheckpoint find_checkpoint(const std::string& path, const std::string& previous) {
  FoundCheckpoint found;
  std::string trouble;
  for (const std::string& candidate : {path, previous}) {
    if (::access(candidate.c_str(), F_OK) != 0) continue;
    try {
      found.reader = std::make_unique<CheckpointReader>(candidate);
      found.path = candidate;
      return found;
    } catch (const IoError& e) {
      found.warnings.push_back(e.what());
      trouble = e.what();
    }
  }
  if (!trouble.empty()) throw IoError(path, "no intact checkpoint is left (" + trouble + ")");
  return found;
}

}  // namespace sphgeo
