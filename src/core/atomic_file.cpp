#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace sphgeo {

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

/// write(2) until all is written; the error number, 0 when done.
int write_fully(int descriptor, const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t n = ::write(descriptor, data, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return ENOSPC;  // no known system does this, but it would be an endless loop
    data += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return 0;
}

/// Hands whole pages to the disk without a copy in the system's cache, which takes ten times the
/// processor time. Returns how many bytes it wrote: fewer than all, or none, where file system,
/// memory alignment or file offset do not allow it.
std::size_t write_directly([[maybe_unused]] int descriptor, [[maybe_unused]] const char* data,
                           [[maybe_unused]] std::size_t bytes,
                           [[maybe_unused]] std::uint64_t offset) {
  std::size_t done = 0;
#if defined(O_DIRECT)
  constexpr std::size_t page = 4096, worth_it = std::size_t{4} << 20;
  if (bytes < worth_it || offset % page != 0 || reinterpret_cast<std::uintptr_t>(data) % page != 0)
    return 0;
  const int flags = ::fcntl(descriptor, F_GETFL);
  if (flags < 0 || ::fcntl(descriptor, F_SETFL, flags | O_DIRECT) != 0) return 0;
  const std::size_t whole = bytes / page * page;
  while (done < whole) {
    const ssize_t n = ::write(descriptor, data + done, whole - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;  // the usual write follows, and reports the error
    done += static_cast<std::size_t>(n);
    if (done % page != 0) break;
  }
  ::fcntl(descriptor, F_SETFL, flags);
#endif
  return done;
}

/// A pipe or a device must not be replaced by a rename.
bool is_special(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

/// Makes a rename survive a power cut, where the file system can.
void sync_folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // Some file systems have nothing to synchronize for a folder.
  if (error != 0 && error != EINVAL && error != ENOTSUP)
    throw_io_error(path, "cannot flush the folder to the disk", error);
}

}  // namespace

void throw_io_error(const std::string& path, const std::string& what, int error_number) {
  throw IoError(path, fmt::format("{}: {}", what, std::strerror(error_number)));
}

void write_all(int descriptor, const void* data, std::size_t bytes, const std::string& path) {
  const int error = write_fully(descriptor, static_cast<const char*>(data), bytes);
  if (error != 0) throw_io_error(path, fmt::format("cannot write {} bytes", bytes), error);
}

AtomicFile::AtomicFile(std::string path, std::uint64_t expected_bytes)
    : path_(std::move(path)),
      temporary_(is_special(path_) ? "" : path_ + ".part"),
      unfinished_(temporary_),
      expected_bytes_(expected_bytes) {
  const bool direct = temporary_.empty();
  const std::string& target = direct ? path_ : temporary_;
  const int flags = O_WRONLY | O_CLOEXEC | (direct ? 0 : O_CREAT | O_TRUNC);
  descriptor_ = ::open(target.c_str(), flags, 0666);
  if (descriptor_ < 0) throw_io_error(path_, "cannot create the file", errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  written_ += bytes;
  if (buffer_.size() + bytes < buffer_bytes) {
    buffer_.append(static_cast<const char*>(data), bytes);
    return;
  }
  flush_buffer();
  const auto* from = static_cast<const char*>(data);
  const std::size_t direct =
      temporary_.empty() ? 0 : write_directly(descriptor_, from, bytes, written_ - bytes);
  const int error = write_fully(descriptor_, from + direct, bytes - direct);
  if (error != 0) fail("cannot write", error);
}

void AtomicFile::commit(const std::string& keep_old_as) {
  flush_buffer();
  // A full disk or a lost network drive may be reported only here. Pipes cannot be synchronized.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail("cannot flush to the disk", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    const int error = errno;
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    throw_io_error(path_, "cannot close the file", error);
  }
  if (temporary_.empty()) return;
  if (!keep_old_as.empty() && std::rename(path_.c_str(), keep_old_as.c_str()) != 0 &&
      errno != ENOENT) {
    const int error = errno;
    ::unlink(temporary_.c_str());
    throw_io_error(path_, "cannot rename the old file to " + keep_old_as, error);
  }
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary_.c_str());
    throw_io_error(path_, "cannot rename the finished file to this name", error);
  }
  if (!keep_old_as.empty()) sync_folder_of(path_);
}

void AtomicFile::flush_buffer() {
  const int error = write_fully(descriptor_, buffer_.data(), buffer_.size());
  if (error != 0) fail("cannot write", error);
  buffer_.clear();
}

void AtomicFile::fail(const std::string& what, int error_number) {
  ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  throw_io_error(path_,
                 fmt::format("{} ({} bytes needed)", what, std::max(expected_bytes_, written_)),
                 error_number);
}

void write_file_atomically(const std::string& path, std::string_view text) {
  AtomicFile file(path, text.size());
  file.write(text);
  file.commit();
}

namespace {

// Reads a file until it ends or more than `limit` bytes are there.
std::string read_up_to(const std::string& path, std::uint64_t limit) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw_io_error(path, "cannot open the file", errno);
  std::string text;
  std::string block(std::size_t{1} << 16, '\0');
  int error = 0;
  for (;;) {
    const ssize_t n = ::read(descriptor, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) error = errno;
    if (n <= 0 || text.size() > limit) break;
    text.append(block.data(), static_cast<std::size_t>(n));
  }
  ::close(descriptor);
  if (error != 0) throw_io_error(path, "cannot read the file", error);
  return text;
}

}  // namespace

std::string read_file(const std::string& path, std::uint64_t limit) {
  std::string text = read_up_to(path, limit);
  if (text.size() > limit) throw IoError(path, fmt::format("larger than {} bytes", limit));
  return text;
}

std::string read_beginning(const std::string& path, std::size_t count) {
  std::string text = read_up_to(path, count);
  text.resize(std::min(text.size(), count));
  return text;
}

}  // namespace sphgeo
