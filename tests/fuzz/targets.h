#pragma once
// What is fuzzed: one function for each reader of foreign bytes. libFuzzer and our own driver call
// the same functions.

#include <span>
#include <string>
#include <string_view>

namespace sphgeo::fuzz {

/// Reads one input. Errors that the reader is documented to throw are caught; anything else that
/// escapes, and any broken promise (see require), is a finding.
struct Target {
  const char* name;  ///< also the folder of its stored inputs below corpus/
  void (*run)(std::string_view input);
  std::size_t longest;  ///< bytes of an input
};

std::span<const Target> targets();
const Target* find_target(std::string_view name);

/// Says what was promised and ends the program when it does not hold.
void require(bool holds, const std::string& promise);

/// A file that lives in memory, for readers that take a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const;

 private:
  int descriptor_;
};

/// A folder of this process for readers that replace the file they read; removed at exit.
const std::string& scratch_folder();

void run_deck(std::string_view input);
void run_set(std::string_view input);
void run_stl(std::string_view input);
void run_csv(std::string_view input);
void run_resume(std::string_view input);
void run_checkpoint(std::string_view input);
void run_terrain(std::string_view input);
void run_motion(std::string_view input);
void run_reference(std::string_view input);

}  // namespace sphgeo::fuzz
