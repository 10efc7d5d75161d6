// The boulder: smooth, seeded, within its bounds, with a distance that is good near its surface.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "geometry/mesh.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::shape_of;

TEST_SUITE("geometry") {
  TEST_CASE(
      "boulder: near its surface the distance is that to the nearest of many surface points") {
    for (const int dim : {2, 3}) {
      CAPTURE(dim);
      const ShapePtr s = shape_of(
          "{type: boulder, center: [0.1, 0, 0.2], radius: 1, roughness: 0.2, seed: 4}", dim);
      const SurfaceMesh mesh = surface_mesh(*s, dim == 2 ? 0.005 : 0.04, dim);
      REQUIRE(mesh.points.size() > 100);
      double least = 9, most = 0;
      for (const Vec3& p : mesh.points) {
        const double r = (p - Vec3(0.1, 0, 0.2)).norm();
        least = std::min(least, r);
        most = std::max(most, r);
      }
      CHECK(least >= 0.8);
      CHECK(most <= 1.2);
      CHECK(most - least > 0.1);  // it is no ball
      Hash hash;
      double worst = 0;
      for (int k = 0; k < 500; ++k) {
        const Vec3 p = hash.in(s->box(), dim);
        const double d = s->signed_distance(p);
        if (std::abs(d) > 0.1) continue;
        double nearest = 9;
        for (const Vec3& q : mesh.points) nearest = std::min(nearest, (p - q).norm());
        // Between points of the mesh the nearest is up to half of its gap aside.
        const double aside = dim == 2 ? 0.0025 : 0.03;
        worst = std::max(worst, std::abs(d) - nearest);
        CHECK(nearest < std::hypot(d, aside) + 0.006);
      }
      CHECK(worst < 0.006);
    }
  }

  TEST_CASE("boulder: the seed decides, and without roughness it is a ball") {
    const auto at = [](const char* more) {
      return shape_of(std::string("{type: boulder, center: [0, 0, 0], radius: 1, ") + more + "}", 3)
          ->signed_distance({0.7, 0.2, 0.6});
    };
    CHECK(at("seed: 1") == at("seed: 1"));
    CHECK(at("seed: 1") != at("seed: 2"));
    CHECK(at("roughness: 0") == doctest::Approx(std::sqrt(0.49 + 0.04 + 0.36) - 1).epsilon(1e-6));
    CHECK(geometry_test::read_shape("{type: boulder, center: [0, 0, 0], radius: 1, roughness: 0.6}",
                                    3)
              .found.has_errors());
  }
}
