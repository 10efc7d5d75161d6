#pragma once
// A file that is composed in memory before it is written.

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>

namespace sphgeo {

/// The bytes of a file, in whole pages, as AtomicFile likes them best. They are not initialized:
/// the threads that fill them also make the system provide the memory.
class FileImage {
 public:
  /// Throws std::bad_alloc.
  explicit FileImage(std::size_t bytes);

  unsigned char* data() { return data_.get(); }
  std::size_t bytes() const { return bytes_; }
  /// Whole or not at all. Throws IoError.
  void write(const std::string& path) const;

 private:
  struct Free {
    void operator()(unsigned char* p) const { std::free(p); }
  };
  std::unique_ptr<unsigned char, Free> data_;
  std::size_t bytes_;
};

}  // namespace sphgeo
