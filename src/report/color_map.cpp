#include "report/color_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/axis.h"
#include "report/markup.h"

namespace sphgeo {

namespace {

/// Lightness and two opponent colours: the space "Oklab" (B. Ottosson, 2020), in which equal
/// distances look equal.
struct Lab {
  double L, a, b;
};

double to_linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
double from_linear(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

Lab to_lab(const Color& c) {
  const double r = to_linear(c.r), g = to_linear(c.g), b = to_linear(c.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Color from_lab(const Lab& c) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(c.L + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cube(c.L - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cube(c.L - 0.0894841775 * c.a - 1.2914855480 * c.b);
  const auto part = [](double v) { return std::clamp(from_linear(std::max(v, 0.0)), 0.0, 1.0); };
  return {part(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          part(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          part(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 1};
}

/// Colours of the map at equal distances.
constexpr std::array anchors{Color{0.20, 0.15, 0.44, 1}, Color{0.17, 0.36, 0.64, 1},
                             Color{0.11, 0.57, 0.62, 1}, Color{0.33, 0.74, 0.45, 1},
                             Color{0.98, 0.88, 0.25, 1}};

}  // namespace

Color map_color(double share) {
  const double s = share > 0 ? std::min(share, 1.0) : 0.0;  // NaN: 0
  const double position = s * (anchors.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(position), anchors.size() - 2);
  const double f = position - static_cast<double>(k);
  const Lab from = to_lab(anchors[k]), to = to_lab(anchors[k + 1]);
  const double darkest = to_lab(anchors.front()).L, lightest = to_lab(anchors.back()).L;
  return from_lab({darkest + s * (lightest - darkest), from.a + f * (to.a - from.a),
                   from.b + f * (to.b - from.b)});
}

std::vector<Color> map_colors(int count) {
  std::vector<Color> colors;
  for (int k = 0; k < count; ++k) colors.push_back(map_color(static_cast<double>(k) / (count - 1)));
  return colors;
}

std::string css_color(const Color& c) {
  const auto byte = [](double part) { return static_cast<int>(std::lround(255 * part)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

std::string color_bar_svg(const std::string& title, const std::string& unit, double low,
                          double high) {
  constexpr double width = 360, margin = 22, bar = 12, top = 22;
  constexpr int steps = 60;
  const AxisScale axis({title, unit, false, low, high}, low, high, 4);
  const std::string heading = axis.title();
  std::string out = fmt::format(
      "<svg class=\"colorbar\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} 54\" "
      "role=\"img\" aria-label=\"{}\" "
      "font-size=\"12.5\" fill=\"currentColor\">\n<text x=\"{}\" y=\"14\">{}</text>\n",
      width, html_escaped(heading), margin, html_escaped(heading));
  const double length = width - 2 * margin;
  for (int k = 0; k < steps; ++k)  // each a little too wide, so that no gap shows
    out +=
        fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" fill=\"{}\"/>",
                    margin + k * length / steps, top, length / steps + (k + 1 < steps ? 0.5 : 0.0),
                    bar, css_color(map_color((k + 0.5) / steps)));
  for (const double t : axis.ticks()) {
    const double x = margin + axis.position(t) * length;
    out += fmt::format(
        "\n<path d=\"M{0:.1f} {1}v4\" stroke=\"currentColor\" stroke-opacity=\".6\"/><text "
        "x=\"{0:.1f}\" y=\"{2}\" text-anchor=\"middle\">{3}</text>",
        x, top + bar, top + bar + 17, axis.text(t));
  }
  return out + "\n</svg>\n";
}

}  // namespace sphgeo
