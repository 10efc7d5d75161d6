// Terrain: planes, bilinear patches against brute force, files, sections.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::read_shape;
using geometry_test::shape_of;

namespace {

double height_at(const ShapePtr& s, double x, double y, double z) {
  return s->signed_distance({x, y, z});
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("height field: an inclined plane is a plane") {
    // z = x / 2 over [0, 4] x [0, 2]
    const ShapePtr h = shape_of(
        "{type: height_field, heights: [0, 0.5, 1, 1.5, 2, 0, 0.5, 1, 1.5, 2], columns: 5, "
        "spacing: 1, spacing_y: 2, bottom: -3}",
        3);
    Hash hash;
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = hash.in({{1.5, 0.6, 0.3}, {2.5, 1.4, 1.7}}, 3);
      const double exact = (p.z() - 0.5 * p.x()) / std::sqrt(1.25);
      if (std::abs(exact) < 0.5)
        CHECK(h->signed_distance(p) == doctest::Approx(exact).epsilon(1e-9));
    }
    CHECK(height_at(h, -1, 1, -1) == doctest::Approx(1.0));
    CHECK(height_at(h, 2, 1, -5) == doctest::Approx(2.0));
    CHECK(height_at(h, -3, 1, -7) == doctest::Approx(5.0));
    CHECK(height_at(h, 0.2, 1, -2) == doctest::Approx(-0.2));
    CHECK(height_at(h, 2, 1, -2.9) == doctest::Approx(-0.1));
    CHECK(h->box().lo.z() == -3.0);
    CHECK(h->box().hi == Vec3(4, 2, 2));
  }

  TEST_CASE("height field: twisted patches against brute force") {
    HeightField f;
    f.heights = {0, 0.4, 0.1, 0.5, 0.0, 0.6, 0.2, 0.3, -0.2};
    f.columns = 3;
    f.spacing = 1.0;
    f.prepare();
    std::vector<Vec3> surface;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; j <= 200; ++j)
        surface.emplace_back(i * 0.01, j * 0.01, f.height(i * 0.01, j * 0.01));
    Hash hash;
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = hash.in({{0.7, 0.7, -0.2}, {1.3, 1.3, 0.8}}, 3);
      double nearest = 1e9;
      for (const Vec3& q : surface) nearest = std::min(nearest, (p - q).norm());
      const double d = f.signed_distance(p);
      CHECK((d < 0.0) == (p.z() < f.height(p.x(), p.y())));
      CHECK(std::abs(d) <= nearest + 1e-9);
      CHECK(std::abs(d) > nearest - 0.01);
    }
  }

  TEST_CASE("height field: file, section of a 2D scene, mistakes") {
    const auto path = std::filesystem::temp_directory_path() / "sphgeo_test_terrain.csv";
    std::ofstream(path) << "# metres\n100,101,102\n110,111,112\n";
    const std::string file = "file: " + path.string();
    const ShapePtr h =
        shape_of("{type: height_field, " + file + ", spacing: 10, origin: [0, 0, -100]}", 3);
    CHECK(std::abs(height_at(h, 10, 5, 6)) < 1e-9);
    CHECK(std::isinf(h->box().lo.z()));
    const ShapePtr flat =
        shape_of("{type: height_field, " + file + ", spacing: 10, section: 5, scale: 0.1}", 2);
    CHECK(height_at(flat, 10, 0, 10.6) == doctest::Approx(0.0).epsilon(1e-9));
    CHECK(flat->box().lo.y() == 0.0);
    std::ofstream(path) << "100,,102\n110,111,112\n";
    CHECK(read_shape("{type: height_field, " + file + ", spacing: 10}", 3)
              .messages()
              .find("shape.file") != std::string::npos);
    std::filesystem::remove(path);
    CHECK(read_shape("{type: height_field, heights: [1, 2, 3], columns: 2, spacing: 1}", 3)
              .messages()
              .find("do not fill rows") != std::string::npos);
    CHECK(read_shape("{type: height_field, spacing: 1}", 3).messages().find("either") !=
          std::string::npos);
    CHECK(read_shape("{type: height_field, heights: [1, 2], spacing: 1, bottom: 1.5}", 3)
              .messages()
              .find("bottom") != std::string::npos);
  }
}
