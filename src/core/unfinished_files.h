#pragma once
// The temporary files that are being written, so that a program that a signal ends can remove them.

#include <string>

namespace sphgeo {

/// Remembers a temporary file as long as it lives.
class UnfinishedFile {
 public:
  /// Beyond sixteen files at once, or 4 KB of path, it remembers nothing. "" is no file.
  explicit UnfinishedFile(const std::string& path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

 private:
  int slot_ = -1;
};

/// Removes all of them. May be called in a signal handler.
void remove_unfinished_files() noexcept;

}  // namespace sphgeo
