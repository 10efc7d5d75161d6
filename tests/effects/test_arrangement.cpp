// How particles lie: the free surface, and the transport displacement of Eq. 87.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include "core/parallel.h"
#include "sph/kernel.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string block(int dimension, double size, const std::string& numerics = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials: [{{name: water, type: water, sound_speed: 20}}]
bodies:
  - {{name: block, material: water, shape: {{type: box, min: [0, 0, 0], max: [{}, {}, {}]}}}}
numerics: {{{}}}
)",
                     dimension, size, size, size, numerics);
}

// Spread (standard deviation) of the number density over particles `margin` away from the surface.
template <int Dim>
double spread(Rig<Dim>& rig, double size, double margin) {
  const auto& x = rig.water().vector(fields::position);
  const Kernel<Dim> kernel(rig.water().smoothing_length());
  double sum = 0, squares = 0, n = 0;
  for (Index i = 0; i < x.size(); ++i) {
    if (test::depth_in_box<Dim>(x[i], Vec<Dim>::Zero(), Vec<Dim>::Constant(size)) < margin)
      continue;
    double number = 0;
    for (Index j = 0; j < x.size(); ++j)
      number += kernel.w((x[i] - x[j]).squaredNorm()) * std::pow(0.1, Dim);
    sum += number;
    squares += number * number;
    ++n;
  }
  REQUIRE(n > 50);
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
}

template <int Dim>
void check_surface(double size, double touched) {
  Rig<Dim> rig(block(Dim, size, "transport_velocity: false"));
  rig.plan_it();
  const auto& x = rig.water().vector(fields::position);
  Index outer = 0, inner = 0, faces = 0;
  for (Index i = 0; i < x.size(); ++i) {
    const double depth = test::depth_in_box<Dim>(x[i], Vec<Dim>::Zero(), Vec<Dim>::Constant(size));
    const int flag = rig.water().tag(fields::surface)[i];
    CAPTURE(depth);
    if (depth < 0.06) {
      ++outer;
      // At a corner less than half of the neighborhood is filled, on a face more.
      const bool face = ((x[i].array() - size / 2).abs() < 0.3 * size).count() == Dim - 1;
      CHECK(flag >= 1);
      if (face) CHECK(flag == 1);
      faces += face;
    } else if (depth > touched) {
      ++inner;
      CHECK(flag == 0);
    }
  }
  CHECK(faces > 0);
  CHECK(outer > faces);
  CHECK(inner > 0);
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("the outermost layer of a block is its surface, the inside is not") {
    check_surface<2>(2.0, 0.16);
    check_surface<3>(1.2, 0.26);
  }

  TEST_CASE("water that touches a wall has no surface there") {
    Rig<2> rig(
        block(2, 2.0, "transport_velocity: false") +
        "boundaries:\n  - {name: tank, type: tank, min: [0, 0, 0], max: [2, 1, 3], open: [top]}\n");
    rig.plan_it();
    const auto& x = rig.water().vector(fields::position);
    Index flagged = 0;
    for (Index i = 0; i < x.size(); ++i) {
      if (rig.water().tag(fields::surface)[i] == 0) continue;
      ++flagged;
      CHECK(x[i][1] > 1.8);
    }
    CHECK(flagged >= 20);
  }

  TEST_CASE("a lonely particle and a pair are surface and stay where they are") {
    Rig<2> rig(block(2, 0.1));
    REQUIRE(rig.water().size() == 1);
    rig.plan_it();
    const Vec<2> before = rig.water().vector(fields::position)[0];
    rig.arrange();
    CHECK(rig.water().tag(fields::surface)[0] == spray);
    CHECK(rig.water().vector(fields::position)[0] == before);
    CHECK(rig.water().scalar(fields::density)[0] == 1000.0);
  }

  TEST_CASE("the transport displacement evens out a jittered block, step by step") {
    Rig<2> rig(block(2, 3.0));
    rig.jitter(0.25);
    const double start = spread(rig, 3.0, 0.9);
    double last = start;
    rig.plan_it();  // arranges once
    for (int k = 0; k < 12; ++k) {
      const double now = spread(rig, 3.0, 0.9);
      CAPTURE(k);
      CHECK(now < last);
      last = now;
      rig.arrange();
    }
    INFO("2D: spread of the number density from ", start, " to ", last);
    CHECK(last < 0.4 * start);
    Rig<3> cube(block(3, 1.6));
    cube.jitter(0.25);
    const double before = spread(cube, 1.6, 0.4);
    cube.plan_it();
    for (int k = 0; k < 3; ++k) cube.arrange();
    INFO("3D: spread of the number density from ", before, " to ", spread(cube, 1.6, 0.4));
    CHECK(spread(cube, 1.6, 0.4) < 0.7 * before);
  }

  TEST_CASE("the transport displacement does not push the surface outwards") {
    Rig<2> rig(block(2, 2.0));
    rig.plan_it();
    for (int k = 0; k < 10; ++k) rig.arrange();
    Aabb box;
    for (Index i = 0; i < rig.water().size(); ++i)
      box.extend(to_space<2>(rig.water().vector(fields::position)[i]));
    const double grown = std::max((box.hi - Vec3(1.95, 0, 1.95)).maxCoeff(), 0.05 - box.lo.x());
    INFO("a lattice block grows by ", grown / 0.1, " spacings in 11 arrangements");
    CHECK(grown < 0.05 * 0.1);
  }

  TEST_CASE("density by summation: exact on a lattice, a surface keeps what it had") {
    Rig<2> rig(block(2, 2.0, "transport_velocity: false"));
    for (Index i = 0; i < rig.water().size(); ++i) rig.water().scalar(fields::density)[i] = 1000;
    rig.plan_it();
    for (Index i = 0; i < rig.water().size(); ++i)
      CHECK(rig.water().scalar(fields::density)[i] == doctest::Approx(1000).epsilon(1e-6));
    // A block squeezed by one per cent along x is denser by one per cent.
    Rig<2> squeezed(block(2, 2.0, "transport_velocity: false"));
    for (Index i = 0; i < squeezed.water().size(); ++i)
      squeezed.water().vector(fields::position)[i].x() /= 1.01;
    squeezed.plan_it();
    const Index middle = test::particle_at<2>(squeezed.water(), {1.05 / 1.01, 1.05});
    REQUIRE(middle >= 0);
    CHECK(squeezed.water().scalar(fields::density)[middle] == doctest::Approx(1010).epsilon(2e-4));
  }
}
