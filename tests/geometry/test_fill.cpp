// Lattice fills and boundary layers.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/fill.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::shape_of;

TEST_SUITE("geometry") {
  TEST_CASE("fill: boxes of whole multiples are filled exactly, whatever the round-off") {
    for (const double dp : {0.1, 0.05, 0.01, 0.02, 1.0 / 3.0 * 0.03}) {
      Box b;
      b.min = {0.1, 0.2, 0.3};
      b.max = b.min + dp * Vec3(21, 7, 13);
      CAPTURE(dp);
      CHECK(fill_lattice(b, dp, 3).size() == 21 * 7 * 13);
      b.flat = true;
      const std::vector<Vec3> flat = fill_lattice(b, dp, 2);
      CHECK(flat.size() == 21 * 13);
      CHECK((flat.front() - Vec3(0.1 + 0.5 * dp, 0, 0.3 + 0.5 * dp)).norm() < 1e-12);
      CHECK(flat[1].x() > flat[0].x());
    }
  }

  TEST_CASE("fill: a box of any size is filled from face to face") {
    for (const int dim : {2, 3}) {
      Box b;
      b.flat = dim == 2;
      b.min = {0.1, -0.2, 0.3};
      for (const Vec3& rows : {Vec3(21, 7, 13), Vec3(20.6, 7.4, 12.51), Vec3(1.4, 3, 0.6)}) {
        CAPTURE(rows.x());
        const double dp = 0.03;
        b.max = b.min + dp * rows;
        const FilledBox filled = fill_box(b, dp, dim);
        Aabb box;
        for (const Vec3& p : filled.at) box.extend(p);
        double size = 1, n = 1;
        for (int k = 0; k < 3; ++k) {
          if (k == 1 && dim == 2) continue;
          const double spacing = rows[k] * dp / std::round(rows[k]);
          CHECK(box.lo[k] - b.min[k] == doctest::Approx(spacing / 2));
          CHECK(b.max[k] - box.hi[k] == doctest::Approx(spacing / 2));
          CHECK(filled.stretch >= std::abs(spacing / dp - 1) - 1e-12);
          size *= rows[k] * dp;
          n *= std::round(rows[k]);
        }
        CHECK(static_cast<double>(filled.at.size()) == n);
        CHECK(n * filled.volume == doctest::Approx(size).epsilon(1e-12));
      }
      // Of whole multiples: the lattice of all other shapes, bit by bit.
      b.max = b.min + 0.03 * Vec3(21, 7, 13);
      const FilledBox filled = fill_box(b, 0.03, dim);
      CHECK(filled.at == fill_lattice(b, 0.03, dim));
      CHECK(filled.volume == std::pow(0.03, dim));
      CHECK(filled.stretch == 0);
      b.max.x() = b.min.x() + 0.01;  // less than half a row
      CHECK(fill_box(b, 0.03, dim).at.empty());
      b.max.x() = b.min.x() + 1e9;
      CHECK_THROWS_AS(fill_box(b, 1e-3, dim), Error);
    }
  }

  TEST_CASE("fill: area and volume of curved shapes within 1 %, points inside, each once") {
    const ShapePtr disc = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 2);
    const auto in_plane = fill_lattice(*disc, 0.02, 2);
    CHECK(static_cast<double>(in_plane.size()) * 4e-4 ==
          doctest::Approx(std::numbers::pi).epsilon(0.01));
    const ShapePtr ball = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 3);
    const auto points = fill_lattice(*ball, 0.05, 3);
    CHECK(static_cast<double>(points.size()) * 1.25e-4 ==
          doctest::Approx(4.0 / 3.0 * std::numbers::pi).epsilon(0.01));
    std::set<std::array<double, 3>> seen;
    for (const Vec3& p : points) {
      CHECK(ball->signed_distance(p) < 0.0);
      seen.insert({p.x(), p.y(), p.z()});
    }
    CHECK(seen.size() == points.size());
    CHECK(estimate_fill(*ball, 0.05, 3, {}) ==
          doctest::Approx(static_cast<double>(points.size())).epsilon(0.02));
  }

  TEST_CASE("fill: skipping by distance loses nothing of a thin composed shape") {
    const ShapePtr s = shape_of(
        "{type: difference, of: [{type: box, min: [0,0,0], max: [1,1,1]}, {type: sphere, center: "
        "[0.5,0.5,0.5], "
        "radius: 0.59}, {type: sphere, center: [0.2,0.2,0.2], radius: 0.11}]}",
        3);
    const double dp = 0.04;
    std::size_t count = 0;
    for (int x = 0; x < 25; ++x)
      for (int y = 0; y < 25; ++y)
        for (int z = 0; z < 25; ++z) count += s->bound(Vec3(x + 0.5, y + 0.5, z + 0.5) * dp) < 0.0;
    CHECK(count > 100);
    CHECK(fill_lattice(*s, dp, 3).size() == count);
  }

  TEST_CASE("fill: points on the seam of touching parts are inside") {
    const ShapePtr u = shape_of(
        "{type: union, of: [{type: box, min: [0,0,0], max: [0.35,1,1]}, {type: box, min: "
        "[0.35,0,0], max: [1,1,1]}]}",
        3);
    CHECK(fill_lattice(*u, 0.1, 3).size() == 1000);
    // The lattice does not take the surface itself for a seam.
    const ShapePtr b =
        shape_of("{type: union, of: [{type: box, min: [0,0,0], max: [0.35,1,1]}]}", 3);
    CHECK(fill_lattice(*b, 0.1, 3).size() == 300);
    const ShapePtr flat = shape_of(
        "{type: union, of: [{type: box, min: [0,0,0], max: [0.35,1,1]}, {type: box, min: "
        "[0.35,0,0], max: [1,1,1]}]}",
        2);
    CHECK(flat->signed_distance({0.35, 0, 0.3}) == doctest::Approx(-0.3).epsilon(0.02));
    CHECK(flat->signed_distance({0.35, 0, 0.0}) == doctest::Approx(0.0));
  }

  TEST_CASE("fill: unbounded and absurd shapes are refused, clips are honoured") {
    const ShapePtr half = shape_of("{type: half_space, point: [0, 0, 0.5]}", 3);
    CHECK_THROWS_AS(fill_lattice(*half, 0.1, 3), Error);
    CHECK(fill_lattice(*half, 0.1, 3, {{0, 0, 0}, {1, 1, 1}}).size() == 500);
    const ShapePtr big = shape_of("{type: box, min: [0,0,0], max: [1000, 1000, 1000]}", 3);
    CHECK_THROWS_WITH(fill_lattice(*big, 1e-3, 3), doctest::Contains("resolution"));
    CHECK(fill_lattice(*big, 0.1, 3, {{0, 0, 0}, {1, 1, 1}}).size() == 1000);
  }

  TEST_CASE("fill: layers around and inside a box are aligned and closed at the corners") {
    Box b;
    b.max = {1.0, 0.5, 0.5};
    CHECK(fill_layers(b, 0.1, 3, 0.3, LayerSide::outside).size() == 16 * 11 * 11 - 10 * 5 * 5);
    CHECK(fill_layers(b, 0.1, 3, 0.2, LayerSide::inside).size() == 10 * 5 * 5 - 6 * 1 * 1);
    b.flat = true;
    CHECK(fill_layers(b, 0.1, 2, 0.3, LayerSide::outside).size() == 16 * 11 - 10 * 5);
    const ShapePtr disc = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 2);
    for (const Vec3& p : fill_layers(*disc, 0.05, 2, 0.2, LayerSide::inside)) {
      CHECK(p.norm() < 1.0);
      CHECK(p.norm() > 0.8 - 1e-9);
    }
    const auto ring = fill_layers(*disc, 0.02, 2, 0.2, LayerSide::outside);
    CHECK(static_cast<double>(ring.size()) * 4e-4 ==
          doctest::Approx(std::numbers::pi * 0.44).epsilon(0.02));
  }

  TEST_CASE("fill: one and three threads give the same points in the same order") {
    const ShapePtr ball = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 3);
    const int before = threads();
    set_threads(1);
    const auto one = fill_lattice(*ball, 0.08, 3);
    set_threads(3);
    const auto three = fill_lattice(*ball, 0.08, 3);
    set_threads(before);
    CHECK(one == three);
  }
}
