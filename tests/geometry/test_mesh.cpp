// Surface meshes for output: closed, outward, on the surface.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/mesh.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::shape_of;

namespace {

/// Enclosed area of directed segments with the solid on the left, and whether every end is a start.
std::pair<double, bool> outline_area(const SurfaceMesh& m) {
  double twice = 0.0;
  std::vector<int> balance(m.points.size(), 0);
  for (const auto& s : m.segments) {
    const Vec3 &a = m.points[static_cast<std::size_t>(s[0])],
               &b = m.points[static_cast<std::size_t>(s[1])];
    twice += a.x() * b.z() - a.z() * b.x();
    ++balance[static_cast<std::size_t>(s[0])];
    --balance[static_cast<std::size_t>(s[1])];
  }
  bool closed = !m.segments.empty();
  for (const int b : balance) closed = closed && b == 0;
  return {0.5 * twice, closed};
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("surface mesh: closed and outward in 3D") {
    for (const char* yaml :
         {"{type: sphere, center: [0, 0, 0], radius: 1}",
          "{type: box, min: [-1, -1, -1], max: [1, 1, 0.0471976]}",
          "{type: shell, of: {type: sphere, center: [0, 0, 0], radius: 1.2}, thickness: 0.2094}"}) {
      CAPTURE(yaml);
      const ShapePtr s = shape_of(yaml, 3);
      const SurfaceMesh m = surface_mesh(*s, 0.07, 3);
      Triangles t{m.points, m.triangles};
      const double volume = enclosed_volume(t);
      CHECK(volume > 0.0);
      const MeshHealth health = repair_orientation(t);
      CHECK(health.open_edges == 0);
      CHECK(health.non_manifold_edges == 0);
      CHECK(health.flipped_faces == 0);
      CHECK_FALSE(health.inside_out);
      double off = 0.0;
      for (const Vec3& p : m.points) off = std::max(off, std::abs(s->signed_distance(p)));
      CHECK(off < 1e-4);
    }
    Sphere s;
    s.radius = 1.0;
    const SurfaceMesh m = surface_mesh(s, 0.07, 3);
    CHECK(enclosed_volume({m.points, m.triangles}) ==
          doctest::Approx(4.0 / 3.0 * std::numbers::pi).epsilon(0.01));
  }

  TEST_CASE("surface mesh: the same with any number of threads") {
    const ShapePtr s = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 3);
    const int before = threads();
    set_threads(1);
    const SurfaceMesh one = surface_mesh(*s, 0.07, 3);
    set_threads(3);
    const SurfaceMesh three = surface_mesh(*s, 0.07, 3);
    set_threads(before);
    CHECK(three.triangles == one.triangles);
    CHECK(three.points == one.points);
  }

  TEST_CASE("surface mesh: closed outlines with the solid on the left in 2D") {
    const auto area = [](const char* yaml, double expected) {
      CAPTURE(yaml);
      const auto [value, closed] = outline_area(surface_mesh(*shape_of(yaml, 2), 0.02, 2));
      CHECK(closed);
      CHECK(value == doctest::Approx(expected).epsilon(0.005));
    };
    area("{type: sphere, center: [3, 0, 1], radius: 1}", std::numbers::pi);
    area("{type: box, min: [0, 0, 0], max: [2, 0, 1]}", 2.0);
    area("{type: polygon, points: [[0,0,0],[0,0,1],[1,0,0]]}", 0.5);
    area("{type: shell, of: {type: sphere, center: [0, 0, 0], radius: 1}, thickness: 0.5}",
         0.75 * std::numbers::pi);
    area(
        "{type: union, of: [{type: box, min: [0,0,0], max: [1,0,1]}, {type: box, min: [1,0,1], "
        "max: [2,0,2]}]}",
        2.0);
  }

  TEST_CASE("surface mesh: unbounded shapes need a clip and are closed by it") {
    const ShapePtr h = shape_of("{type: half_space, point: [0, 0, 0.5]}", 2);
    CHECK_THROWS_AS(surface_mesh(*h, 0.1, 2), Error);
    const auto [value, closed] = outline_area(surface_mesh(*h, 0.05, 2, {{0, 0, 0}, {2, 0, 1}}));
    CHECK(closed);
    CHECK(value == doctest::Approx(1.0).epsilon(0.01));
  }
}
