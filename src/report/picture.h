#pragma once
// Small pictures with a palette, as PNG.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sphgeo {

/// Parts of red, green, blue and opacity in 0..1, in the sRGB of screens.
struct Color {
  double r = 0, g = 0, b = 0, a = 1;
};

/// A picture of at most 256 colours, row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<Color> palette;
  std::vector<std::uint8_t> pixels;  ///< numbers in the palette

  std::uint8_t at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
};

/// The picture as the bytes of a PNG file. Throws std::invalid_argument when it has no pixel, too
/// many colours or a pixel without a colour.
std::string png(const Picture& picture);

}  // namespace sphgeo
