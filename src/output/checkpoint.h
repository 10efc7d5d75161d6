#pragma once
// checkpoint.h5: the state of a run, from which it continues with bitwise the same results.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/state_file.h"

namespace sphgeo {

inline StateFileKind checkpoint_kind() { return {"checkpoint 5", "checkpoint"}; }

/// Collects the state of a run.
class CheckpointWriter final : public StateFileWriter {
 public:
  explicit CheckpointWriter(std::size_t expected_bytes = 0)
      : StateFileWriter(checkpoint_kind(), expected_bytes) {}
};

/// Restores the state. Throws as StateFileReader.
class CheckpointReader final : public StateFileReader {
 public:
  explicit CheckpointReader(const std::string& path) : StateFileReader(checkpoint_kind(), path) {}
  CheckpointReader(std::string bytes, const std::string& path)
      : StateFileReader(checkpoint_kind(), std::move(bytes), path) {}
};

/// The newest sound checkpoint of a run.
struct FoundCheckpoint {
  std::unique_ptr<CheckpointReader> reader;  ///< null when there is none at all
  std::string path;
  std::vector<std::string> warnings;  ///< the defect of a newer one
};

/// Opens `path`, or `previous` when that is missing or damaged. Throws IoError when there are
/// checkpoints and all are damaged.
FoundCheckpoint find_checkpoint(const std::string& path, const std::string& previous);

}  // namespace sphgeo
