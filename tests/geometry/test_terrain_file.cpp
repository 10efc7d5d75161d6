// Terrain from files of other programs: grids of maps, points, holes.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "geometry/terrain_file.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::read_shape;
using geometry_test::shape_of;

namespace {

/// A terrain file that disappears with the test.
struct TerrainText {
  explicit TerrainText(const std::string& text)
      : path((std::filesystem::temp_directory_path() / "sphgeo_test_terrain_file").string()) {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~TerrainText() { std::filesystem::remove(path); }
  std::string path;
};

TerrainGrid terrain(const std::string& text, const std::string& format = "auto") {
  return read_terrain(TerrainText(text).path, format, std::nullopt);
}

std::string terrain_complaint(const std::string& text, const std::string& format = "auto") {
  try {
    terrain(text, format);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

bool complains(const std::string& text, const std::string& of) {
  const std::string said = terrain_complaint(text);
  CAPTURE(said);
  return said.find(of) != std::string::npos;
}

std::string deck_complaint(const std::string& text, const std::string& keys) {
  const TerrainText file(text);
  return read_shape("{type: height_field, file: " + file.path + keys + "}", 3).messages();
}

const std::string map_grid =
    "NCOLS 3\r\nnrows 2\nxllcorner 556440\nyllcorner 5394932\ncellsize 2\n"
    "NODATA_value -9999\n4 5 6\n1 2 3\n";

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("an ESRI grid runs from north to south, with heights at the centres of cells") {
    const TerrainGrid g = terrain(map_grid);
    CHECK(g.nx == 3);
    CHECK(g.ny == 2);
    CHECK(g.heights == std::vector<double>{1, 2, 3, 4, 5, 6});
    CHECK(g.placed);
    CHECK(g.x == 556441);
    CHECK(g.y == 5394933);
    CHECK(g.dx == 2);
    const TerrainGrid centred =
        terrain("ncols 2\nnrows 1\nxllcenter 10\nyllcenter 20\ncellsize 1\n-9999 7\n");
    CHECK(centred.x == 10);
    CHECK(centred.y == 20);
    CHECK(std::isnan(centred.heights[0]));
  }

  TEST_CASE("an ESRI grid that is cut off, too long or without a key is refused with its line") {
    CHECK(complains("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3\n",
                    "line 8: expected a number, and the file ends here"));
    CHECK(complains("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n",
                    "'2' after the last of 1 x 1 heights"));
    CHECK(complains("ncols 1\nnrows 1\nyllcorner 0\ncellsize 1\n1\n", "no 'xllcorner'"));
    CHECK(
        complains("ncols 1\nnrows 1\nxllcorner 0\nyllcorner nan\n", "'yllcorner' is not a finite"));
    CHECK(complains("ncols 1\nnrows 1\nxllcorner +-5\n", "expected a number, found '+-5'"));
    CHECK(complains("ncols 1\nncols 1\n", "'ncols' is given twice"));
    CHECK(
        complains("ncols 99999\nnrows 99999\nxllcorner 0\nyllcorner 0\ncellsize 1\n", "too many"));
    CHECK(
        complains("ncols 1.5\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n", "'ncols' is 1.5"));
    CHECK(complains("ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0\n1\n", "positive"));
  }

  TEST_CASE("points of a grid may come in any order and unit") {
    const TerrainGrid g =
        terrain("x [cm];y [cm];z [cm]\n100;50;30\n0;0;1\n50;0;2\n0;50;4\n100;0;3\n");
    CHECK(g.nx == 3);
    CHECK(g.ny == 2);
    CHECK(g.dx == 0.5);
    CHECK(g.heights[0] == 0.01);
    CHECK(g.heights[5] == 0.3);
    CHECK(std::isnan(g.heights[4]));
  }

  TEST_CASE("points that lie on no grid, or twice on a node, are refused") {
    CHECK(complains("x,y,z\n0,0,1\n1,0,1\n2.10,0,1\n3,0,1\n", ":4: the point at x = 2.1 m"));
    CHECK(complains("x,y,z\n0,0,1\n1,0,1\n0,0,2\n", ":4: the same point as"));
    CHECK(complains("x,y,height\n0,0,1\n", "no column 'height'"));
    std::string scattered = "x,y,z\n";
    for (int k = 0; k < 40; ++k)
      scattered += std::to_string(k * 7 % 41) + "," + std::to_string(k * 13 % 43) + ",1\n";
    CHECK(complains(scattered, "lie on no grid"));
  }

  TEST_CASE("points whose coordinates are rounded lie on the grid that was rounded") {
    const auto rounded = [](double step, int lines, int digits, double origin) {
      std::string text = "x,y,z\n";
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < lines; ++i)
          text += fmt::format("{:.{}f},{:.{}f},{}\n", origin + i * step, digits, j * step, digits,
                              i + 10 * j);
      return text;
    };
    for (const auto& [step, digits] : {std::pair{1.0 / 3, 2}, std::pair{1.0 / 6, 2},
                                       std::pair{0.125, 2}, std::pair{0.25, 1}, std::pair{0.1, 6}})
      for (const int lines : {5, 301})
        for (const double origin : {0.0, 12.34, -0.057}) {
          CAPTURE(step);
          CAPTURE(lines);
          CAPTURE(origin);
          const TerrainGrid g = terrain(rounded(step, lines, digits, origin));
          REQUIRE(g.nx == lines);
          CHECK(g.ny == 3);
          CHECK(g.heights[static_cast<std::size_t>(lines) + 4] == 14);
          CHECK(std::abs(g.dx - step) <= g.slack + 1e-9 * step);
          CHECK(std::abs(g.x - origin) <= 1.01 * std::pow(10.0, -digits));
        }
    // A missing line, and a deck that knows the step.
    CHECK(terrain("x,y,z\n0.00,0,1\n0.33,0,2\n1.00,0,3\n1.33,0,4\n1.67,0,5\n").nx == 6);
    const std::string thirds = "x,y,z\n0.00,0,1\n0.33,0,2\n0.67,0,3\n1.00,0,4\n1.33,0,5\n";
    CHECK(deck_complaint(thirds, ", spacing: 1/3").empty());
    CHECK(deck_complaint(thirds, ", spacing: 0.35").find("the deck says otherwise") !=
          std::string::npos);
    // Two decimals show more than this: no grid.
    CHECK(complains("x,y,z\n0.00,0,1\n1.00,0,1\n2.04,0,1\n3.00,0,1\n", "lies on no grid"));
  }

  TEST_CASE("one line of points is a profile, along x or along y") {
    const auto read = [](const std::string& text) {
      const TerrainText file(text);
      return shape_of("{type: height_field, bottom: -1, file: " + file.path + "}", 3);
    };
    const std::string along_y = "x,y,z\n5,0,1\n5,1,2\n5,2,4\n";
    const ShapePtr a = read("x,y,z\n0,5,1\n1,5,2\n2,5,4\n"), b = read(along_y);
    for (const Vec3& at : {Vec3(0.5, 7, 1.6), Vec3(1.5, -3, 2), Vec3(-1, 0, 0), Vec3(1, 1, -2)}) {
      const double d = a->signed_distance(at);
      CHECK(b->signed_distance({at.y(), at.x(), at.z()}) == d);
    }
    CHECK(b->box().lo.y() == 0);
    CHECK(b->box().hi.y() == 2);
    CHECK(std::isinf(b->box().hi.x()));
    const TerrainText file(along_y);
    CHECK(read_shape("{type: height_field, file: " + file.path + "}", 2)
              .messages()
              .find("on one line along y") != std::string::npos);
  }

  TEST_CASE("headers of ESRI grids: comments, contradictions, infinite heights") {
    CHECK(terrain("# from a map\n#\n" + map_grid).nx == 3);
    const std::string start = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    CHECK(complains(start + "xllcenter 0\n1 2\n",
                    "'xllcorner' and 'xllcenter' are both given: leave one of them out"));
    CHECK(complains(start + "dx 2\n1 2\n", "'cellsize' and 'dx' are both given"));
    CHECK(complains(start + "1 inf\n", "line 6: a height is infinite"));
    CHECK(complains(start + "1 1e-400\n", "line 6: '1e-400' is too close to zero"));
    CHECK(std::isnan(terrain(start + "1 -nan\n").heights[1]));
  }

  TEST_CASE("a bad number in the first row of a grid is said with its column") {
    CHECK(complains("1,2,x3\n4,5,6\n", ":1: column 3: 'x3' is not a finite number"));
    CHECK(terrain_complaint("1,2,x3\n4,5,6\n", "grid").find(":1: column 3: 'x3'") !=
          std::string::npos);
    CHECK(complains("1,2,3\n4,5,x6\n", ":2: column '3': 'x6' is not a finite number"));
  }

  TEST_CASE("three columns without names that look like points are not taken for heights") {
    const std::string points = "0,0,5\n1,0,6\n0,1,7\n1,1,8\n";
    CHECK(complains(points, "x, y, z of points?"));
    CHECK(terrain(points, "grid").nx == 3);
    CHECK(terrain("5,6,7\n5,7,9\n4,4,5\n3,3,4\n").nx == 3);
  }

  TEST_CASE("a map's coordinates are moved to the scene, and said to be when they are not") {
    const TerrainText file(map_grid);
    const std::string said =
        read_shape("{type: height_field, file: " + file.path + "}", 3).messages();
    CAPTURE(said);
    CHECK(said.find("map_origin: [556441, 5394933, 0]") != std::string::npos);
    const ShapePtr h = shape_of("{type: height_field, file: " + file.path +
                                    ", map_origin: [556441, 5394933, 1], bottom: -5}",
                                3);
    CHECK(h->box().lo == Vec3(0, 0, -5));
    CHECK(h->box().hi == Vec3(4, 2, 5));
    CHECK(deck_complaint(map_grid, ", map_origin: [556441, 5394933, 0], spacing: 1")
              .find("the heights of the file are 2 m by 2 m apart") != std::string::npos);
    CHECK(deck_complaint("1,2\n3,4\n", "").find("`spacing` is missing") != std::string::npos);
  }

  TEST_CASE("holes are refused, or filled from the heights around them") {
    const std::string grid = "1,2,3,4\n2,-9999,4,5\n3,,5,6\n4,5,6,7\n";
    CHECK(deck_complaint(grid, ", spacing: 1")
              .find("2 of 16 heights are missing, the first at x = 1, y = 1 m") !=
          std::string::npos);
    const TerrainText file(grid);
    const auto filled =
        read_shape("{type: height_field, spacing: 1, holes: fill, file: " + file.path + "}", 3);
    CHECK(filled.messages().find("2 heights are missing and were filled") != std::string::npos);
    // A plane is a solution of Laplace's equation.
    CHECK(filled.shape->signed_distance({1, 1, 3}) == doctest::Approx(0).epsilon(1e-6));
    CHECK(
        deck_complaint("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value 0\n0 "
                       "-9999\n",
                       "")
            .find("no height is known") != std::string::npos);
    CHECK(deck_complaint("-9999,-9999\n", ", spacing: 1, holes: fill").find("no height is known") !=
          std::string::npos);
    CHECK(deck_complaint("0,0\n0,7\n", ", spacing: 1, no_data: 7").find("1 of 4 heights") !=
          std::string::npos);
  }
}
