// Terrain from files of other programs: grids of maps, points, holes.

#include <doctest/doctest.h>

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
    CHECK(complains("x,y,z\n0,0,1\n1,0,1\n2.1,0,1\n3,0,1\n", ":4: the point at x = 2.1 m"));
    CHECK(complains("x,y,z\n0,0,1\n1,0,1\n0,0,2\n", ":4: the same point as"));
    CHECK(complains("x,y,height\n0,0,1\n", "no column 'height'"));
    std::string scattered = "x,y,z\n";
    for (int k = 0; k < 40; ++k)
      scattered += std::to_string(k * 7 % 41) + "," + std::to_string(k * 13 % 43) + ",1\n";
    CHECK(complains(scattered, "lie on no grid"));
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
