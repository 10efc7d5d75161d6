#include <doctest/doctest.h>
#include <png.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "report/color_map.h"
#include "report/painter.h"

using namespace sphgeo;

namespace {

/// A PNG as libpng reads it back, four bytes a pixel.
struct Read {
  int width = 0, height = 0;
  std::vector<unsigned char> rgba;
};

Read read_png(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_RGBA;
  Read out{static_cast<int>(image.width), static_cast<int>(image.height),
           std::vector<unsigned char>(PNG_IMAGE_SIZE(image))};
  REQUIRE(png_image_finish_read(&image, nullptr, out.rgba.data(), 0, nullptr));
  return out;
}

double lightness(const Color& c) {
  return 0.2126 * std::pow(c.r, 2.2) + 0.7152 * std::pow(c.g, 2.2) + 0.0722 * std::pow(c.b, 2.2);
}

std::set<int> colors_in(const Picture& p) { return {p.pixels.begin(), p.pixels.end()}; }

}  // namespace

TEST_SUITE("report") {
  TEST_CASE("a disc lands on its pixels") {
    const View view = view_of({Vec3(0, 0, 0), Vec3(2, 0, 1)}, 2, 212, 400);
    CHECK(view.scale == doctest::Approx(100));
    CHECK(view.width == 212);
    CHECK(view.height == 112);
    Painter painter(view, {Color{1, 0, 0, 1}, Color{0, 1, 0, 1}});
    const std::vector<Vec3> places{{0.5, 0, 0.25}, {1.5, 0, 0.75}};
    const std::vector<std::uint8_t> colors{0, 1};
    painter.discs(places, 0.2, colors);
    const Picture p = painter.picture();
    CHECK(p.at(56, 81) == 1);  // 6 + 50 from the left, 6 + 75 from the top
    CHECK(p.at(156, 31) == 2);
    CHECK(p.at(56 + 9, 81) == 1);
    CHECK(p.at(56 + 11, 81) == 0);
    CHECK(p.at(56 + 8, 81 + 8) == 0);  // round, no square
    CHECK(p.at(106, 56) == 0);
  }

  TEST_CASE("in 3D the nearer ball hides the other, whatever comes first") {
    const View view = view_of({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, 3, 200, 200);
    const Vec3 behind = Vec3::Zero(), before = behind + 0.5 * view.toward;
    for (const bool swapped : {false, true}) {
      Painter painter(view, {Color{1, 0, 0, 1}, Color{0, 1, 0, 1}});
      const std::vector<Vec3> places =
          swapped ? std::vector{before, behind} : std::vector{behind, before};
      const std::vector<std::uint8_t> colors =
          swapped ? std::vector<std::uint8_t>{1, 0} : std::vector<std::uint8_t>{0, 1};
      painter.discs(places, 0.3, colors);
      painter.line({-1, 0, 0}, {1, 0, 0}, 2, 0);
      const Picture p = painter.picture();
      const int middle =
          p.at(static_cast<int>(view.column(before)), static_cast<int>(view.row(before)));
      CHECK(p.palette[static_cast<std::size_t>(middle)].g > 0.3);
      CHECK(p.palette[static_cast<std::size_t>(middle)].r == 0);
    }
  }

  TEST_CASE("walls of any length, places that are no numbers, and particles outside") {
    const View view = view_of({Vec3(0, 0, 0), Vec3(1, 0, 1)}, 2, 100, 100);
    Painter painter(view, {Color{0.5, 0.5, 0.5, 1}});
    painter.line({-1e9, 0, 0.5}, {1e9, 0, 0.5}, 2, 0);
    painter.line({0, 0, std::nan("")}, {1, 0, 1}, 2, 0);
    painter.line({5, 0, 5}, {6, 0, 6}, 2, 0);
    const std::vector<Vec3> places{{std::nan(""), 0, 0}, {1e30, 0, 0}, {-50, 0, 0.5}};
    const std::vector<std::uint8_t> colors{0, 0, 0};
    painter.discs(places, 0.1, colors);
    painter.mark({1e12, 0, 0}, 5, 0);
    const Picture p = painter.picture();
    CHECK(p.at(0, 50) == 1);
    CHECK(p.at(99, 50) == 1);
    CHECK(p.at(50, 10) == 0);
    CHECK_THROWS_AS(view_of({}, 2, 100, 100), std::invalid_argument);
  }

  TEST_CASE("a PNG reads back with its colours") {
    Painter painter(view_of({Vec3(0, 0, 0), Vec3(1, 0, 1)}, 2, 100, 80), map_colors(40));
    std::vector<Vec3> places;
    std::vector<std::uint8_t> colors;
    for (int i = 0; i < 40; ++i) {
      places.emplace_back((i + 0.5) / 40, 0, 0.5);
      colors.push_back(static_cast<std::uint8_t>(i));
    }
    painter.discs(places, 0.05, colors);
    const Picture p = painter.picture();
    CHECK(colors_in(p).size() == 41);
    const Read read = read_png(png(p));
    CHECK(read.width == p.width);
    CHECK(read.height == p.height);
    for (std::size_t k = 0; k < p.pixels.size(); ++k) {
      const Color& c = p.palette[p.pixels[k]];
      REQUIRE(read.rgba[4 * k + 3] == (p.pixels[k] == 0 ? 0 : 255));
      if (p.pixels[k] != 0) REQUIRE(read.rgba[4 * k + 1] == std::lround(255 * c.g));
    }
    CHECK_THROWS_AS(png(Picture{}), std::invalid_argument);
    CHECK_THROWS_AS(png(Picture{1, 1, {Color{}}, {3}}), std::invalid_argument);
  }

  TEST_CASE("equal steps of the colours are equal steps of lightness, and their ends are kept") {
    const auto colors = map_colors(21);
    for (std::size_t k = 1; k < colors.size(); ++k)
      CHECK(lightness(colors[k]) > lightness(colors[k - 1]));
    CHECK(css_color(map_color(-3)) == css_color(map_color(0)));
    CHECK(css_color(map_color(std::nan(""))) == css_color(map_color(0)));
    CHECK(css_color(map_color(7)) == css_color(map_color(1)));
    const std::string bar = color_bar_svg("speed <x>", "m/s", 0, 2);
    CHECK(bar.find("speed &lt;x&gt; (m/s)") != std::string::npos);
    CHECK(bar.find(">2.0</text>") != std::string::npos);
  }

  TEST_CASE("the outline of a box has twelve edges") {
    std::vector<Vec3> points;
    std::vector<Index> corners;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {0.0, 1.0}) {
        const auto at = [&](double u, double v) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = u;
          p[(axis + 2) % 3] = v;
          points.push_back(p);
          return static_cast<Index>(points.size()) - 1;
        };
        const Index a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
        // Both orders, so that normals point alike.
        for (const Index k :
             side > 0 ? std::vector{a, b, c, a, c, d} : std::vector{a, c, b, a, d, c})
          corners.push_back(k);
      }
    CHECK(outline(points, 3, corners).size() == 12);
    // A face without area between two others, as surfaces that were cut from a grid have, draws
    // nothing.
    points.push_back(points[static_cast<std::size_t>(corners[0])]);
    for (const Index k : {corners[0], static_cast<Index>(points.size()) - 1, corners[1]})
      corners.push_back(k);
    CHECK(outline(points, 3, corners).size() == 12);
    CHECK(outline(points, 2, std::vector<Index>{0, 1, 1, 2}).size() == 2);
    CHECK(outline(points, 1, {}).empty());
  }
}
