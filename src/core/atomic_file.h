#pragma once
// Files that appear whole or not at all.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/unfinished_files.h"

namespace sphgeo {

/// Writes all bytes to an open file descriptor. Throws IoError with the path and the system's
/// message.
void write_all(int descriptor, const void* data, std::size_t bytes, const std::string& path);

/// Throws IoError: "path: <what>: <text of the error number>".
[[noreturn]] void throw_io_error(const std::string& path, const std::string& what,
                                 int error_number);

/// A file written under a temporary name beside its final one. Only commit() makes it visible;
/// without it the destructor removes the temporary file, so that no half-written file stays;
/// remove_unfinished_files() does so when a signal ends the program.
/// A path that is not a regular file (a pipe, /dev/stdout) is written to directly.
/// Every failure is an IoError with the path, the bytes needed and the system's message.
class AtomicFile {
 public:
  /// Opens `path` + ".part". `expected_bytes` (0 = unknown) is told when the disk is full.
  explicit AtomicFile(std::string path, std::uint64_t expected_bytes = 0);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Writes what is buffered, flushes it to the disk, closes and renames. A file that is there
  /// already is renamed to `keep_old_as` before, unless that is empty.
  void commit(const std::string& keep_old_as = {});

  std::uint64_t bytes_written() const { return written_; }

 private:
  void flush_buffer();
  [[noreturn]] void fail(const std::string& what, int error_number);

  std::string path_;
  std::string temporary_;  ///< empty when written to directly
  UnfinishedFile unfinished_;
  std::string buffer_;
  std::uint64_t expected_bytes_;
  std::uint64_t written_ = 0;
  int descriptor_ = -1;
};

/// Replaces the file by `text`, whole or not at all. Throws IoError.
void write_file_atomically(const std::string& path, std::string_view text);

/// The whole file. Throws IoError, also when it is larger than `limit` bytes.
std::string read_file(const std::string& path, std::uint64_t limit = std::uint64_t{1} << 30);

/// Its first bytes, at most `count`. Throws IoError.
std::string read_beginning(const std::string& path, std::size_t count);

}  // namespace sphgeo
