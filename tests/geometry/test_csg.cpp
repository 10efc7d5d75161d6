// Union, intersection, difference, complement, shell and transform.

#include <doctest/doctest.h>

#include <cmath>

#include "geometry/mesh.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::shape_of;

namespace {

double at(const ShapePtr& s, double x, double y, double z) { return s->signed_distance({x, y, z}); }

const std::string left_box = "{type: box, min: [0, 0, 0], max: [1, 1, 1]}";
const std::string right_box = "{type: box, min: [1, 0, 0], max: [2, 1, 1]}";

/// Largest relative disagreement with the nearest of many surface points, for points within
/// `reach`.
double worst_error(const ShapePtr& s, int dim, double gap, double reach) {
  const SurfaceMesh mesh = surface_mesh(*s, gap, dim);
  REQUIRE(mesh.points.size() > 100);
  Hash hash;
  double worst = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 p = hash.in(s->box().grown(0.2), dim);
    const double d = std::abs(s->signed_distance(p));
    if (d > reach || d < 2.0 * gap) continue;
    double nearest = 1e9;
    for (const Vec3& q : mesh.points) nearest = std::min(nearest, (p - q).norm());
    worst = std::max(worst, std::abs(nearest - d) / d);
  }
  return worst;
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("union: abutting boxes are one box, the seam is no surface") {
    const ShapePtr u = shape_of("{type: union, of: [" + left_box + ", " + right_box + "]}", 3);
    CHECK(at(u, 3, 0.5, 0.5) == doctest::Approx(1.0));
    CHECK(at(u, 0.95, 0.5, 0.4) == doctest::Approx(-0.4).epsilon(0.01));
    CHECK(at(u, 1.2, 0.3, 0.5) == doctest::Approx(-0.3).epsilon(0.01));
    CHECK(at(u, 0.1, 0.5, 0.5) == doctest::Approx(-0.1));
    const ShapePtr flat = shape_of("{type: union, of: [" + left_box + ", " + right_box + "]}", 2);
    CHECK(at(flat, 1.02, 0, 0.3) == doctest::Approx(-0.3).epsilon(0.01));
    CHECK(flat->box().hi.x() == 2.0);
  }

  TEST_CASE("intersection and difference: rounded outside, exact inside") {
    const ShapePtr i = shape_of(
        "{type: intersection, of: [" + left_box + ", {type: half_space, point: [0, 0, 0.5]}]}", 3);
    CHECK(at(i, 0.5, 0.5, 0.4) == doctest::Approx(-0.1));
    CHECK(at(i, 1.3, 0.5, 0.9) == doctest::Approx(0.5).epsilon(0.02));
    CHECK(i->box().hi.z() == 0.5);
    const ShapePtr d = shape_of("{type: difference, of: [" + left_box +
                                    ", {type: sphere, center: [0.5, 0.5, 0.5], radius: 0.3}]}",
                                3);
    CHECK(at(d, 0.5, 0.5, 0.5) == doctest::Approx(0.3));
    CHECK(at(d, 0.5, 0.5, 0.9) == doctest::Approx(-0.1));
    CHECK(at(d, 0.5, 0.5, 1.2) == doctest::Approx(0.2));
    // An L: in the notch both faces count, above its upper edge the air sees a round corner.
    const ShapePtr c = shape_of("{type: difference, of: [" + left_box +
                                    ", {type: box, min: [0.5, -1, 0.5], max: [2, 2, 2]}]}",
                                3);
    CHECK(at(c, 0.75, 0.5, 0.75) == doctest::Approx(0.25));
    CHECK(at(c, 0.4, 0.5, 1.1) == doctest::Approx(0.1));
    CHECK(at(c, 0.8, 0.5, 1.4) == doctest::Approx(0.5).epsilon(0.02));
  }

  TEST_CASE("composed distances agree with surface points near the surface") {
    const std::string balls =
        "of: [{type: sphere, center: [0, 0, 0], radius: 0.5}, {type: sphere, center: [0.5, 0, "
        "0.1], radius: 0.4}]}";
    for (const char* type : {"union", "intersection", "difference"}) {
      CAPTURE(type);
      CHECK(worst_error(shape_of(std::string("{type: ") + type + ", " + balls, 2), 2, 0.002, 0.3) <
            0.03);
      CHECK(worst_error(shape_of(std::string("{type: ") + type + ", " + balls, 3), 3, 0.015, 0.3) <
            0.06);
    }
    const ShapePtr nested = shape_of(
        "{type: difference, of: [{type: union, of: [{type: box, min: [0,0,0], max: [1,1,0.4]}, "
        "{type: box, min: [0,0,0.4], max: [0.4,1,1]}]}, {type: sphere, center: [0.4,0.5,0.4], "
        "radius: 0.15}]}",
        2);
    CHECK(worst_error(nested, 2, 0.002, 0.3) < 0.03);
  }

  TEST_CASE("shell: inside, outside and centered") {
    const std::string of = "of: {type: sphere, center: [0, 0, 0], radius: 1}, thickness: 0.2";
    for (const auto& [side, inner, outer] :
         {std::tuple{"inside", 0.8, 1.0}, {"outside", 1.0, 1.2}, {"centered", 0.9, 1.1}}) {
      const ShapePtr s = shape_of("{type: shell, " + of + ", side: " + side + "}", 3);
      CAPTURE(side);
      CHECK(at(s, inner, 0, 0) == doctest::Approx(0.0).epsilon(1e-9));
      CHECK(at(s, outer, 0, 0) == doctest::Approx(0.0).epsilon(1e-9));
      CHECK(at(s, 0.5 * (inner + outer), 0, 0) == doctest::Approx(-0.1));
      CHECK(at(s, 0, 0, 0) == doctest::Approx(inner));
      CHECK(s->box().hi.x() == doctest::Approx(outer));
    }
  }

  TEST_CASE("transform: scale, turn about a point, move; boxes follow") {
    const ShapePtr t = shape_of(
        "{type: transform, of: {type: box, min: [0,0,0], max: [2,1,1]}, scale: 2, "
        "rotate: 90 deg, about: [0,0,0], translate: [0,0,1]}",
        3);
    // x turns to z: the box becomes x in [-2, 0], z in [1, 5].
    CHECK(at(t, -1, 1, 3) == doctest::Approx(-1.0));
    CHECK(at(t, -1, 1, 6) == doctest::Approx(1.0));
    CHECK(t->box().lo.x() == doctest::Approx(-2.0));
    CHECK(t->box().hi.z() == doctest::Approx(5.0));
    const ShapePtr flat = shape_of(
        "{type: transform, of: {type: box, min: [0,0,0], max: [2,1,1]}, "
        "rotate: -90 deg, axis: [0, 1, 0]}",
        2);
    CHECK(at(flat, -0.5, 0, 1) == doctest::Approx(-0.5));
    const ShapePtr half = shape_of(
        "{type: transform, of: {type: half_space, point: [0,0,0]}, translate: [0,0,3]}", 3);
    CHECK(half->box().hi.z() == doctest::Approx(3.0));
    CHECK(std::isinf(half->box().lo.z()));
    CHECK(geometry_test::read_shape(
              "{type: transform, of: " + left_box + ", rotate: 1, axis: [1,0,0]}", 2)
              .messages()
              .find("along y") != std::string::npos);
  }

  TEST_CASE("complement and disjoint intersections") {
    const ShapePtr c = shape_of("{type: complement, of: " + left_box + "}", 3);
    CHECK(at(c, 0.5, 0.5, 0.5) == doctest::Approx(0.5));
    CHECK(at(c, 2, 0.5, 0.5) == doctest::Approx(-1.0));
    CHECK(geometry_test::read_shape("{type: intersection, of: [" + left_box +
                                        ", {type: box, min: [3,0,0], max: [4,1,1]}]}",
                                    3)
              .messages()
              .find("no point in common") != std::string::npos);
  }
}
