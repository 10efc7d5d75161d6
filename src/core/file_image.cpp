#include "core/file_image.h"

#include <new>

#include "core/atomic_file.h"

namespace sphgeo {

FileImage::FileImage(std::size_t bytes) : bytes_(bytes) {
  constexpr std::size_t page = 4096;
  data_.reset(static_cast<unsigned char*>(std::aligned_alloc(page, (bytes + page) / page * page)));
  if (!data_) throw std::bad_alloc();
}

void FileImage::write(const std::string& path) const {
  AtomicFile file(path, bytes_);
  file.write(data_.get(), bytes_);
  file.commit();
}

}  // namespace sphgeo
