#include "targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace sphgeo::fuzz {

namespace {

// The readers' own limits for sizes are tested by hand; short inputs find more here.
constexpr std::array all{Target{"deck", run_deck, 1 << 14},
                         Target{"set", run_set, 1 << 12},
                         Target{"stl", run_stl, 1 << 14},
                         Target{"csv", run_csv, 1 << 14},
                         Target{"resume", run_resume, 1 << 14},
                         Target{"checkpoint", run_checkpoint, 1 << 12},
                         Target{"terrain", run_terrain, 1 << 14},
                         Target{"motion", run_motion, 1 << 14},
                         Target{"reference", run_reference, 1 << 14}};

/// Owns the scratch folder until the process ends.
struct Scratch {
  std::string path;
  Scratch() {
    // In memory when there is such a place: the readers flush their files to the disk.
    const std::string parent = std::filesystem::is_directory("/dev/shm")
                                   ? "/dev/shm"
                                   : std::filesystem::temp_directory_path().string();
    path = parent + "/sphgeo-fuzz-XXXXXX";
    if (::mkdtemp(path.data()) == nullptr) {
      std::perror(path.c_str());
      std::exit(2);
    }
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

std::span<const Target> targets() { return all; }

const Target* find_target(std::string_view name) {
  for (const Target& t : all)
    if (t.name == name) return &t;
  return nullptr;
}

void require(bool holds, const std::string& promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
  std::abort();
}

MemoryFile::MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("input", MFD_CLOEXEC)) {
  const bool whole = descriptor_ >= 0 && ::write(descriptor_, bytes.data(), bytes.size()) ==
                                             static_cast<ssize_t>(bytes.size());
  if (!whole) {
    std::perror("memfd");
    std::exit(2);
  }
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

std::string MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

const std::string& scratch_folder() {
  static const Scratch scratch;
  return scratch.path;
}

}  // namespace sphgeo::fuzz
