#include <doctest/doctest.h>

#include <cmath>

#include "core/direction.h"
#include "core/hash.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("directions are unit vectors for lengths of every size") {
    CHECK(direction_of({0, 2, 0}) == Vec3(0, 1, 0));
    CHECK(direction_of({0, 0, 0}) == Vec3(0, 0, 0));
    CHECK(direction_of({1, -2, 3}) == Vec3(1, -2, 3).normalized());
    for (const double size : {1e300, 1e200, 1e-160, 1e-200, 1e-320}) {
      CAPTURE(size);
      CHECK((direction_of({-size, 0, 0}) - Vec3(-1, 0, 0)).norm() == 0);
      CHECK((direction_of({size, 0, size}) - Vec3(1, 0, 1) / std::sqrt(2.0)).norm() < 1e-15);
    }
    CHECK(direction_of({1e300, 0, 1e-8}) == Vec3(1, 0, 0));
    CHECK(direction_of({1e8, -1e-300, 0}).y() == 0);
    for (std::uint64_t k = 0; k < 2000; ++k) {
      const Vec3 once =
          direction_of(Vec3(random_uniform(1, k), random_uniform(2, k), random_uniform(3, k)) -
                       Vec3::Constant(0.5));
      CHECK(direction_of(once) == once);
    }
    CHECK((direction_of({-1e300, 1, 0}) - Vec3(-1, 0, 0)).norm() < 1e-15);
  }
}
