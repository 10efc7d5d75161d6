#include "report/picture.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sphgeo {

std::string png(const Picture& p) {
  if (p.width < 1 || p.height < 1 ||
      p.pixels.size() != static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height))
    throw std::invalid_argument("a picture without pixels");
  if (p.palette.empty() || p.palette.size() > 256 ||
      *std::max_element(p.pixels.begin(), p.pixels.end()) >= p.palette.size())
    throw std::invalid_argument("a picture whose pixels are not in its palette");
  std::vector<png_byte> colors;
  for (const Color& c : p.palette)
    for (const double part : {c.r, c.g, c.b, c.a})
      colors.push_back(static_cast<png_byte>(std::lround(255 * std::clamp(part, 0.0, 1.0))));

  // The simplified interface of libpng: it returns its errors, where the other one would jump over
  // destructors.
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(p.width);
  image.height = static_cast<png_uint_32>(p.height);
  image.format = PNG_FORMAT_RGBA_COLORMAP;
  image.colormap_entries = static_cast<png_uint_32>(p.palette.size());
  image.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string out(bytes, '\0');
  if (png_image_write_to_memory(&image, out.data(), &bytes, 0, p.pixels.data(), 0, colors.data()) ==
      0) {
    const std::string why = image.message;
    png_image_free(&image);
    throw std::runtime_error("cannot write a PNG: " + why);
  }
  out.resize(bytes);
  return out;
}

}  // namespace sphgeo
