// Distances of the single shapes: closed forms, gradients, and brute force over their surface
// points.

#include <doctest/doctest.h>

#include <cmath>

#include "geometry/mesh.h"
#include "geometry/normal.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::read_shape;
using geometry_test::shape_of;

namespace {

double at(const ShapePtr& s, double x, double y, double z) { return s->signed_distance({x, y, z}); }

/// Points of a surface mesh no farther apart than about `gap`.
std::vector<Vec3> spread(const SurfaceMesh& mesh, double gap) {
  std::vector<Vec3> out = mesh.points;
  const auto corner = [&](std::int32_t k) { return mesh.points[static_cast<std::size_t>(k)]; };
  for (const auto& s : mesh.segments) {
    const Vec3 a = corner(s[0]), ab = corner(s[1]) - a;
    const int n = static_cast<int>(ab.norm() / gap) + 1;
    for (int i = 1; i < n; ++i) out.push_back(a + i * ab / n);
  }
  for (const auto& t : mesh.triangles) {
    const Vec3 a = corner(t[0]), ab = corner(t[1]) - a, ac = corner(t[2]) - a;
    const int n = static_cast<int>(std::max(ab.norm(), ac.norm()) / gap);
    if (n < 2) continue;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) out.push_back(a + (i * ab + j * ac) / n);
  }
  return out;
}

/// Compares the distance at random points with the nearest of many points on the surface, and looks
/// at the slope along the normal, which must be 1.
void against_surface_points(const std::string& yaml, int dim, double gap) {
  CAPTURE(yaml);
  CAPTURE(dim);
  const ShapePtr s = shape_of(yaml, dim);
  const SurfaceMesh mesh = surface_mesh(*s, gap, dim, Aabb{Vec3::Constant(-3), Vec3::Constant(3)});
  const std::vector<Vec3> surface = spread(mesh, gap);
  REQUIRE(surface.size() > 100);
  Hash hash;
  int inside = 0;
  double worst_near = 0.0, worst_far = 0.0, worst_gradient = 0.0;
  for (int k = 0; k < 150; ++k) {
    const Vec3 p = hash.in(s->box().grown(dim == 2 ? 0.4 : 0.3), dim);
    const double d = s->signed_distance(p);
    inside += d < 0.0;
    double nearest = 1e9;
    for (const Vec3& q : surface) nearest = std::min(nearest, (p - q).norm());
    worst_near = std::max(worst_near, std::abs(d) - nearest);
    worst_far = std::max(worst_far, nearest - std::abs(d));
    // Away from ridges the foot of the normal lies on the surface.
    const Vec3 n = outward_normal(*s, p, 1e-6, dim);
    const double slope =
        (s->signed_distance(p + 1e-6 * n) - s->signed_distance(p - 1e-6 * n)) / 2e-6;
    if (std::abs(slope - 1.0) > 1e-3) worst_gradient += 1.0;
  }
  CHECK(inside > 5);
  CHECK(inside < 140);
  CHECK(worst_near < 0.01 * gap);
  CHECK(worst_far < 2.5 * gap);  // sharp edges are cut off
  CHECK(worst_gradient <= 3.0);  // random points that happen to lie on a ridge
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("box: closed form inside, beside a face, beside an edge and a corner") {
    const ShapePtr b = shape_of("{type: box, min: [0, 0, 0], max: [2, 2, 1]}", 3);
    CHECK(at(b, 1, 1, 0.5) == -0.5);
    CHECK(at(b, 3, 1, 0.5) == 1.0);
    CHECK(at(b, 5, 6, 0.5) == doctest::Approx(5.0));
    CHECK(at(b, 3, 4, 3) == doctest::Approx(3.0));
    CHECK(b->box().hi == Vec3(2, 2, 1));
    const ShapePtr flat = shape_of("{type: box, min: [0, 0, 0], max: [2, 0, 1]}", 2);
    CHECK(at(flat, 1, 0, 0.4) == doctest::Approx(-0.4));
    CHECK(at(flat, 5, 0, 5) == doctest::Approx(5.0));
    CHECK(flat->box().hi.y() == 0.0);
  }

  TEST_CASE("round shapes: closed forms") {
    const ShapePtr s = shape_of("{type: sphere, center: [1, 2, 3], radius: 0.5}", 3);
    CHECK(at(s, 1, 2, 3) == -0.5);
    CHECK(at(s, 1, 2, 5) == 1.5);
    const ShapePtr c = shape_of("{type: cylinder, from: [0, 0, 0], to: [0, 0, 2], radius: 1}", 3);
    CHECK(at(c, 0, 0, 1) == doctest::Approx(-1.0));
    CHECK(at(c, 0.9, 0, 1) == doctest::Approx(-0.1));
    CHECK(at(c, 4, 0, 6) == doctest::Approx(5.0));
    const ShapePtr k = shape_of("{type: capsule, from: [0, 0, 0], to: [0, 0, 2], radius: 1}", 3);
    CHECK(at(k, 3, 0, 6) == doctest::Approx(4.0));
    const ShapePtr cone =
        shape_of("{type: cone, from: [0, 0, 0], to: [0, 0, 1], radius_from: 1}", 3);
    CHECK(at(cone, 0, 0, 2) == doctest::Approx(1.0));
    CHECK(at(cone, 1, 0, 1) == doctest::Approx(std::sqrt(0.5)));
    CHECK(at(cone, 0, 0, 0.1) == doctest::Approx(-0.1));
    const ShapePtr disc =
        shape_of("{type: cylinder, from: [0, 0, 1], to: [0, 5, 1], radius: 0.5}", 2);
    CHECK(at(disc, 0, 0, 0) == doctest::Approx(0.5));
    const ShapePtr h = shape_of("{type: half_space, point: [0, 0, 1], normal: [0, 0, 2]}", 3);
    CHECK(at(h, 5, 5, 3) == doctest::Approx(2.0));
    CHECK(h->box().hi.z() == 1.0);
  }

  TEST_CASE("ellipsoid: a ball is a ball, and the distance survives the axes and the middle") {
    const Vec3 e{1.0, 1.0, 1.0};
    Hash hash;
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = hash.in({Vec3::Constant(-2), Vec3::Constant(2)}, 3);
      CHECK(ellipsoid_distance(p, e) == doctest::Approx(p.norm() - 1.0).epsilon(1e-9));
    }
    CHECK(ellipsoid_distance({0, 0, 0}, {3, 2, 0.5}) == doctest::Approx(-0.5));
    CHECK(ellipsoid_distance({5, 0, 0}, {3, 2, 0.5}) == doctest::Approx(2.0));
    CHECK(ellipsoid_distance({0, 0, 0.5}, {3, 2, 0.5}) == doctest::Approx(0.0).epsilon(1e-12));
    // On the long axis inside: nearest point at x = a^2 x0 / (a^2 - c^2).
    const double x = 9.0 * 1.0 / (9.0 - 0.25), z = 0.5 * std::sqrt(1.0 - x * x / 9.0);
    CHECK(ellipse_distance({1, 0}, {3, 0.5}) == doctest::Approx(-std::hypot(x - 1.0, z)));
    CHECK(ellipse_distance({-1, 1e-9}, {3, 0.5}) == doctest::Approx(-std::hypot(x - 1.0, z)));
    CHECK(std::abs(ellipsoid_distance({1e6, 0, 0}, {1e-3, 1, 1}) - (1e6 - 1e-3)) < 1e-3);
  }

  TEST_CASE("polygon: concave, either sense, repeated corners; prism ends") {
    const std::string l = "points: [[0,0,0],[2,0,0],[2,0,1],[1,0,1],[1,0,2],[0,0,2]]";
    const ShapePtr p = shape_of("{type: polygon, " + l + "}", 2);
    CHECK(at(p, 1.5, 0, 1.5) == doctest::Approx(0.5));
    CHECK(at(p, 0.9, 0, 0.9) == doctest::Approx(-std::sqrt(0.02)));
    const ShapePtr back = shape_of(
        "{type: polygon, points: "
        "[[0,0,2],[1,0,2],[1,0,1],[2,0,1],[2,0,0],[0,0,0],[0,0,0],[0,0,2]]}",
        2);
    CHECK(at(back, 0.9, 0, 0.9) == at(p, 0.9, 0, 0.9));
    const ShapePtr prism = shape_of("{type: prism, " + l + ", y_min: 0, y_max: 1}", 3);
    CHECK(at(prism, 0.5, 0.9, 0.5) == doctest::Approx(-0.1));
    CHECK(at(prism, 5.0, 5.0, 0.5) == doctest::Approx(5.0));
    const ShapePtr open = shape_of("{type: polygon, " + l + "}", 3);
    CHECK(at(open, 0.5, 1e6, 0.5) == doctest::Approx(-0.5));
    CHECK(std::isinf(open->box().hi.y()));
  }

  TEST_CASE("every single shape agrees with its surface points in both dimensions") {
    for (const int dim : {2, 3}) {
      const double gap = dim == 2 ? 0.01 : 0.08;
      against_surface_points("{type: box, min: [0, 0, 0], max: [1, 0.8, 0.6]}", dim, gap);
      against_surface_points("{type: sphere, center: [0.1, 0, 0], radius: 0.7}", dim, gap);
      against_surface_points("{type: ellipsoid, center: [0, 0, 0], semi_axes: [1, 0.5, 0.4]}", dim,
                             gap);
      against_surface_points("{type: cylinder, from: [0, 0, 0], to: [0.5, 0, 1], radius: 0.4}", dim,
                             gap);
      against_surface_points(
          "{type: cone, from: [0, 0, 0], to: [0.2, 0, 1], radius_from: 0.6, radius_to: 0.2}", dim,
          gap);
      against_surface_points("{type: capsule, from: [0, 0, 0], to: [0.5, 0, 1], radius: 0.3}", dim,
                             gap);
      against_surface_points(
          "{type: prism, y_min: 0, y_max: 0.7, points: [[0,0,0],[1,0,0],[0.4,0,0.4],[0,0,1]]}", dim,
          gap);
    }
  }

  TEST_CASE("what a shape cannot be is said where it stands") {
    const auto says = [](const std::string& yaml, int dim, const std::string& what) {
      CAPTURE(yaml);
      const std::string all = read_shape(yaml, dim).messages();
      CAPTURE(all);
      CHECK(all.find(what) != std::string::npos);
    };
    says("{type: box, min: [0, 0, 0], max: [1, 0, 1]}", 3,
         "shape.max: max must be larger than min in y");
    says("{type: sphere, center: [0, 0, 0], radius: 0}", 3, "shape.radius");
    says("{type: ellipsoid, center: [0, 0, 0], semi_axes: [1, 0, 1]}", 3, "semi_axes");
    says("{type: cylinder, from: [0, 0, 0], to: [0, 0, 0], radius: 1}", 3, "coincide");
    says("{type: cone, from: [0, 0, 0], to: [0, 0, 1], radius_from: 0}", 3, "both radii");
    says("{type: polygon, points: [[0,0,0],[1,0,1],[1,0,0],[0,0,1]]}", 2, "crosses");
    says("{type: polygon, points: [[0,0,0],[1,0,1]]}", 2, "points");
    says("{type: half_space, point: [0, 0, 0], normal: [0, 0, 0]}", 3, "no direction");
    says("{type: prism, points: [[0,0,0],[1,0,0],[0,0,1]], y_min: 1, y_max: 0}", 3, "y_max");
    says("{type: sphre, center: [0, 0, 0], radius: 1}", 3, "sphre");
    CHECK(read_shape("{type: box, min: [0, 0, 0], max: [1, 0, 1]}", 2).messages().empty());
  }

  TEST_CASE("normals at faces, edges and in the middle; projection to a level") {
    const ShapePtr b = shape_of("{type: box, min: [0, 0, 0], max: [1, 1, 1]}", 3);
    CHECK((outward_normal(*b, {0.9, 0.5, 0.5}, 1e-3, 3) - Vec3(1, 0, 0)).norm() < 1e-9);
    CHECK((outward_normal(*b, {1.1, 0.5, 1.1}, 1e-3, 3) - Vec3(1, 0, 1).normalized()).norm() <
          1e-9);
    CHECK(outward_normal(*b, {0.5, 0.5, 0.5}, 1e-3, 3).norm() == doctest::Approx(1.0));
    const ShapePtr e = shape_of("{type: ellipsoid, center: [0, 0, 0], semi_axes: [1, 0, 0.5]}", 2);
    const Vec3 q = project_to_level(*e, {0.6, 0, 0.2}, -0.05, 1e-3, 2);
    CHECK(e->signed_distance(q) == doctest::Approx(-0.05).epsilon(1e-6));
    CHECK(q.y() == 0.0);
  }
}
