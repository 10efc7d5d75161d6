// The mangrove: roots that leave the trunk and reach the ground, within its bounds, another for
// another seed.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/fill.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::read_shape;
using geometry_test::shape_of;

namespace {

std::string tree(const std::string& more) {
  return "{type: mangrove, foot: [1, 2, 0.5], height: 1.2, trunk_radius: 0.06, root_radius: 0.03, "
         "root_height: 0.6, spread: 0.5" +
         more + "}";
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE(
      "mangrove: it stands on roots between half of the spread and all of it, and fits its box") {
    const ShapePtr s = shape_of(tree(", roots: 14, branching: 0.7"), 3);
    const Aabb box = s->box();
    double farthest = 0;
    int touching = 0;
    for (const Vec3& p : fill_lattice(*s, 0.01, 3)) {
      CHECK(box.contains(p));
      const double out = std::hypot(p.x() - 1, p.y() - 2);
      farthest = std::max(farthest, out);
      if (p.z() < 0.51) {
        ++touching;
        CHECK(out > 0.4 * 0.5);  // no trunk at the ground
      }
    }
    CHECK(touching > 20);
    CHECK(farthest > 0.4);
    CHECK(farthest < 0.5 + 0.03 + 1e-9);
    CHECK(s->signed_distance({1, 2, 1.65}) == doctest::Approx(-0.06));
    CHECK(s->signed_distance({1, 2, 0.6}) > 0);
  }

  TEST_CASE("mangrove: the distance never changes by more than the way, which a wrong cull would") {
    const ShapePtr s = shape_of(tree(", roots: 30"), 3);
    Hash hash;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 a = hash.in(s->box().grown(0.3), 3), b = hash.in(s->box().grown(0.3), 3);
      REQUIRE(std::abs(s->signed_distance(a) - s->signed_distance(b)) <= (a - b).norm() + 1e-12);
    }
  }

  TEST_CASE("mangrove: a seed decides, and roots go on below the ground when asked") {
    const Vec3 at(1.2, 2.1, 0.7);
    CHECK(shape_of(tree(""), 3)->signed_distance(at) == shape_of(tree(""), 3)->signed_distance(at));
    CHECK(shape_of(tree(", seed: 2"), 3)->signed_distance(at) !=
          shape_of(tree(""), 3)->signed_distance(at));
    CHECK(shape_of(tree(", below: 0.2"), 3)->box().lo.z() <
          shape_of(tree(""), 3)->box().lo.z() - 0.19);
    CHECK_FALSE(read_shape("{type: mangrove, foot: [0, 0, 0], height: 0.5, trunk_radius: 0.1, "
                           "root_radius: 0.1, root_height: 0.6, spread: 1}",
                           3)
                    .messages()
                    .empty());
  }
}
