// Level-set-guided relaxation: body-fitted, even, the same for any number of threads.

#include <doctest/doctest.h>

#include <cmath>

#include "core/parallel.h"
#include "geometry/level_set_mesh.h"
#include "geometry/relax_fill.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::shape_of;

namespace {

/// One thread while it lives: these runs are too small to share.
struct OneThread {
  OneThread() { set_threads(1); }
  ~OneThread() { set_threads(before); }
  int before = threads();
};

/// The outermost layer lies dp/2 below the surface, density is even, nothing is outside.
void check_fitted(const std::string& yaml, double dp, int dim, double measure) {
  CAPTURE(yaml);
  CAPTURE(dim);
  const OneThread one;
  const ShapePtr s = shape_of(yaml, dim);
  const RelaxFillResult r = relax_fill(*s, dp, dim);
  REQUIRE(r.positions.size() > 300);
  CHECK(r.density_spread < 0.03);
  CHECK(r.density_spread < 0.5 * r.history.front().density_spread);
  CHECK(r.density_low > 0.9);
  CHECK(r.density_high < 1.1);
  CHECK(r.surface_offset < 0.1);
  double least_gap = 1e9;
  int outermost = 0;
  for (std::size_t i = 0; i < r.positions.size(); ++i) {
    const double d = s->signed_distance(r.positions[i]);
    CHECK(d < -0.49 * dp);
    outermost += d > -0.6 * dp;
    if (i < 200)
      for (std::size_t j = 0; j < i; ++j)
        least_gap = std::min(least_gap, (r.positions[i] - r.positions[j]).norm());
  }
  CHECK(least_gap > 0.7 * dp);
  CHECK(static_cast<double>(r.positions.size()) * r.particle_volume ==
        doctest::Approx(measure).epsilon(0.01));
  // A closed layer holds about surface / dp^(dim-1) particles.
  CHECK(outermost >
        0.75 * std::pow(measure / std::pow(dp, dim), (dim - 1.0) / dim) * (dim == 2 ? 3.0 : 4.2));
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("relaxation: kernel and what it misses beyond a plane wall") {
    const OneThread one;
    for (const int dim : {2, 3}) {
      const double dp = 0.1, h = 0.13;
      const RelaxKernel kernel(h, dim);
      CHECK(kernel.value(2.0 * h) == 0.0);
      CHECK(kernel.slope(0.1) ==
            doctest::Approx((kernel.value(0.1001) - kernel.value(0.0999)) / 2e-4 / 0.1)
                .epsilon(1e-5));
      Box b;
      b.max = {2, 2, 2};
      b.flat = dim == 2;
      const LevelSetMesh mesh(b, b.box(), 0.5 * dp, kernel, dim);
      CHECK(mesh.volume() == doctest::Approx(dim == 2 ? 4.0 : 8.0).epsilon(0.005));
      const Vec3 middle{1, dim == 2 ? 0.0 : 1.0, 1};
      CHECK(mesh.missing(middle).sum == 0.0);
      // On the wall itself half of the kernel is missing.
      const Vec3 wall{2, middle.y(), 1};
      CHECK(mesh.missing(wall).sum == doctest::Approx(0.5).epsilon(0.02));
      CHECK(mesh.missing(wall).gradient.x() > 0.0);
      CHECK(std::abs(mesh.missing(wall).gradient.z()) < 1e-4);
    }
  }

  TEST_CASE("relaxation: discs, ellipses and balls are body-fitted and even") {
    check_fitted("{type: sphere, center: [0, 0, 0], radius: 1}", 0.06, 2, 3.14159);
    check_fitted("{type: ellipsoid, center: [0.3, 0, 0], semi_axes: [1, 0, 0.5]}", 0.05, 2, 1.5708);
    check_fitted("{type: sphere, center: [0, 0, 0], radius: 1}", 0.16, 3, 4.18879);
  }

  TEST_CASE("relaxation: a turned box is even, a lattice box is at rest") {
    const OneThread one;
    const ShapePtr b = shape_of("{type: box, min: [0, 0, 0], max: [1, 0, 1]}", 2);
    const RelaxFillResult rest = relax_fill(*b, 0.05, 2);
    CHECK(rest.converged);
    CHECK(rest.density_spread < 0.01);
    CHECK(rest.surface_offset < 0.01);
    const ShapePtr t = shape_of(
        "{type: transform, of: {type: box, min: [0, 0, 0], max: [1, 0, 1]}, rotate: 27 deg}", 2);
    const RelaxFillResult turned = relax_fill(*t, 0.05, 2);
    CHECK(turned.density_spread < 0.03);
    CHECK(turned.surface_offset < 0.1);
  }

  TEST_CASE("relaxation: the same bits for one and three threads") {
    const ShapePtr s = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 2);
    RelaxFillOptions o;
    o.steps = 5;
    const int before = threads();
    set_threads(1);
    const RelaxFillResult one = relax_fill(*s, 0.04, 2, o);
    set_threads(3);
    const RelaxFillResult three = relax_fill(*s, 0.04, 2, o);
    set_threads(before);
    CHECK(one.positions == three.positions);
    CHECK(one.density_spread == three.density_spread);
    CHECK(one.history.size() == 5);
  }
}
