#pragma once
// From numbers to colours: dark blue over green to yellow, perceptually uniform.

#include <string>
#include <vector>

#include "report/picture.h"

namespace sphgeo {

/// The colour of a share in 0..1 (NaN and what lies outside: of the nearer end). Its lightness
/// grows linearly, so that equal steps look equal, also in grey.
Color map_color(double share);

/// `count` >= 2 colours from 0 to 1.
std::vector<Color> map_colors(int count);

/// "#1f9e96".
std::string css_color(const Color& color);

/// A bar of colours with numbers and a title "pressure (Pa)", as one <svg> element in the colour of
/// the text.
std::string color_bar_svg(const std::string& title, const std::string& unit, double low,
                          double high);

}  // namespace sphgeo
