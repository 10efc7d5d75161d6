#include <doctest/doctest.h>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>

#include "core/hash.h"
#include "materials/hyperelastic.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string solid_block(int dimension, const std::string& more = "", const std::string& body = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials: [{{name: rubber, type: elastic, density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.3}}]
bodies:
  - name: block
    material: rubber
    shape: {{type: box, min: [0, 0, 0], max: [0.8, 0.6, 0.7]}}
    {}
{})",
                     dimension, body, more);
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> turn(double angle) {
  const Mat3 r =
      Eigen::AngleAxisd(angle, Vec3(Dim == 3 ? 0.6 : 0, Dim == 3 ? 0.0 : 1, Dim == 3 ? 0.8 : 0))
          .toRotationMatrix();
  if constexpr (Dim == 3) {
    return r;
  } else {
    Eigen::Matrix2d m;
    m << r(0, 0), r(0, 2), r(2, 0), r(2, 2);
    return m;
  }
}

template <int Dim>
void check_rotation(const std::string& numerics, double tolerance) {
  Rig<Dim> rig(solid_block(Dim, numerics));
  auto& set = rig.world.set("solids");
  const auto r = turn<Dim>(2.0);
  for (Index i = 0; i < set.size(); ++i)
    set.vector(fields::position)[i] =
        r * set.vector(fields::reference_position)[i] + Vec<Dim>::Constant(0.3);
  rig.plan_it({{"solids", "von_mises", "test", false}});
  rig.plan->run(Stage::observe);
  rig.world.clock.dt_solid = 0;
  rig.plan->run(Stage::solid_predict);
  rig.plan->run(Stage::solid_force);
  double most = 0, pull = 0;
  for (Index i = 0; i < set.size(); ++i) {
    most = std::max(most, set.tensor(fields::cauchy_stress)[i].norm());
    pull = std::max(pull, set.vector(fields::acceleration_sum)[i].norm());
  }
  CHECK(most < tolerance * 1e6);
  CHECK(pull < tolerance * 1e6 / (1000 * 0.1));
}

/// Stretches, shears and turns the block alike everywhere.
template <int Dim>
void check_patch() {
  Rig<Dim> rig(solid_block(Dim, "numerics: {pair_precision: double}"));
  auto& set = rig.world.set("solids");
  rig.jitter_set("solids", 0.0);
  Eigen::Matrix<double, Dim, Dim> f = turn<Dim>(0.7);
  Eigen::Matrix<double, Dim, Dim> stretch = Eigen::Matrix<double, Dim, Dim>::Identity();
  stretch(0, 0) = 1.1;
  stretch(Dim - 1, 0) = 0.05;
  f = f * stretch;
  for (Index i = 0; i < set.size(); ++i)
    set.vector(fields::position)[i] = f * set.vector(fields::reference_position)[i];
  rig.plan_it({{"solids", "von_mises", "test", false}});
  rig.plan->run(Stage::observe);
  // Every particle has the same energy, also at faces and corners: B0 sees a linear field exactly.
  const auto& energy = set.scalar(fields::strain_energy);
  for (Index i = 0; i < set.size(); ++i)
    CHECK(energy[i] == doctest::Approx(energy[0]).epsilon(1e-10));
  CHECK(set.scalar(fields::volume)[0] == doctest::Approx(1.1 * std::pow(0.1, Dim)).epsilon(1e-10));
}

template <int Dim>
double disturb(Rig<Dim>& rig, double by) {
  auto& set = rig.world.set("solids");
  rig.jitter_set("solids", by);
  double sum = 0;
  for (Index i = 0; i < set.size(); ++i) sum += set.scalar(fields::mass)[i];
  return sum;
}

template <int Dim>
void check_momentum_of_solids(const std::string& numerics, double tolerance) {
  Rig<Dim> rig(solid_block(Dim, numerics));
  disturb(rig, 0.1);
  rig.plan_it();
  rig.world.clock.dt_solid = 0;
  rig.plan->run(Stage::solid_predict);
  rig.plan->run(Stage::solid_force);
  const auto& set = rig.world.set("solids");
  Vec<Dim> sum = Vec<Dim>::Zero();
  double size = 0;
  for (Index i = 0; i < set.size(); ++i) {
    const Vec<Dim> f = set.scalar(fields::mass)[i] * set.vector(fields::acceleration_sum)[i];
    sum += f;
    size += f.norm();
  }
  CHECK(size > 0);
  CHECK(sum.norm() < tolerance * size);
}

/// Work of the internal forces on a small displacement against the change of the strain energy.
template <int Dim>
void check_energy(const std::string& numerics, const std::string& body = "") {
  Rig<Dim> rig(solid_block(Dim, numerics, body));
  disturb(rig, 0.1);
  for (Index i = 0; i < rig.world.set("solids").size(); ++i)
    if (rig.world.set("solids").tag(fields::clamp)[i] >= 0)
      rig.world.set("solids").vector(fields::position)[i] =
          rig.world.set("solids").vector(fields::reference_position)[i];
  rig.plan_it({{"solids", "strain_energy", "test", false}});
  auto& set = rig.world.set("solids");
  rig.world.clock.dt_solid = 0;
  rig.plan->run(Stage::solid_predict);
  rig.plan->run(Stage::solid_force);
  const auto energy = [&] {
    rig.plan->run(Stage::observe);
    double sum = 0;
    for (Index i = 0; i < set.size(); ++i) sum += set.scalar(fields::strain_energy)[i];
    return sum;
  };
  double work = 0;
  std::vector<Vec<Dim>> step;
  for (Index i = 0; i < set.size(); ++i) {
    Vec<Dim> u;
    for (int k = 0; k < Dim; ++k)
      u[k] = (set.tag(fields::clamp)[i] < 0 ? 1e-6 : 0) *
             (2 * random_uniform(9, static_cast<std::uint64_t>(Dim * i + k)) - 1);
    step.push_back(u);
    work += set.scalar(fields::mass)[i] * set.vector(fields::acceleration_sum)[i].dot(u);
  }
  auto& x = set.vector(fields::position);
  for (Index i = 0; i < set.size(); ++i) x[i] += 0.5 * step[static_cast<std::size_t>(i)];
  const double up = energy();
  for (Index i = 0; i < set.size(); ++i) x[i] -= step[static_cast<std::size_t>(i)];
  const double down = energy();
  CHECK(up - down == doctest::Approx(-work).epsilon(1e-6));
}

/// Largest error of the strain energy of a bent block, in parts of the largest.
template <int Dim>
double bending_error(const std::string& gradient) {
  Rig<Dim> rig(
      solid_block(Dim, "numerics: {pair_precision: double, solid_gradient: " + gradient + "}"));
  auto& set = rig.world.set("solids");
  const double bend = 1e-3;
  for (Index i = 0; i < set.size(); ++i) {
    const Vec<Dim> at = set.vector(fields::reference_position)[i];
    Vec<Dim> u = Vec<Dim>::Zero();
    u[0] = -bend * at[0] * at[Dim - 1];
    u[Dim - 1] = bend * (0.5 * at[0] * at[0] + 0.3 * at[Dim - 1] * at[Dim - 1]);
    set.vector(fields::position)[i] = at + u;
  }
  rig.plan_it({{"solids", "strain_energy", "test", false}});
  rig.plan->run(Stage::observe);
  const auto& energy = set.scalar(fields::strain_energy);
  double worst = 0, most = 0;
  for (Index i = 0; i < set.size(); ++i) {
    const Vec<Dim> at = set.vector(fields::reference_position)[i];
    Mat3 g = Mat3::Zero();
    g(0, 0) = -bend * at[Dim - 1];
    g(0, 2) = -bend * at[0];
    g(2, 0) = bend * at[0];
    g(2, 2) = 0.6 * bend * at[Dim - 1];
    const double expected =
        std::pow(0.1, Dim) * strain_energy_density(g, {1e6 / 2.6, 1e6 * 0.3 / (1.3 * 0.4), true});
    worst = std::max(worst, std::abs(energy[i] - expected));
    most = std::max(most, expected);
  }
  return worst / most;
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE(
      "the quadratic gradient sees bending as it is, also at faces and corners; the linear one "
      "does not") {
    CHECK(bending_error<2>("quadratic") < 1e-5);
    CHECK(bending_error<3>("quadratic") < 1e-5);
    CHECK(bending_error<2>("linear") > 0.05);
  }
  TEST_CASE("a turned solid bears no stress") {
    check_rotation<2>("numerics: {pair_precision: double}", 1e-12);
    check_rotation<3>("numerics: {pair_precision: double}", 1e-12);
    check_rotation<2>("", 1e-6);
    check_rotation<3>("", 1e-6);
  }
  TEST_CASE("a solid deformed alike everywhere is stressed alike everywhere") {
    check_patch<2>();
    check_patch<3>();
  }
  TEST_CASE("internal forces of a solid keep its momentum") {
    check_momentum_of_solids<2>("numerics: {pair_precision: double}", 1e-14);
    check_momentum_of_solids<3>("numerics: {pair_precision: double}", 1e-14);
    check_momentum_of_solids<2>("numerics: {pair_precision: double, solid_gradient: quadratic}",
                                1e-13);
    check_momentum_of_solids<3>("numerics: {pair_precision: double, solid_gradient: quadratic}",
                                1e-13);
    check_momentum_of_solids<2>("", 1e-6);
    check_momentum_of_solids<3>("", 1e-6);
  }
  TEST_CASE("internal forces of a solid are the gradient of its strain energy") {
    for (const std::string gradient : {"linear", "quadratic"}) {
      check_energy<2>("numerics: {pair_precision: double, solid_gradient: " + gradient + "}");
      check_energy<3>("numerics: {pair_precision: double, solid_gradient: " + gradient + "}");
      check_energy<2>(
          "numerics: {pair_precision: double, solid_gradient: " + gradient + "}",
          "clamped: [{shape: {type: half_space, point: [0.2, 0, 0], normal: [1, 0, 0]}}]");
    }
  }
  TEST_CASE("a clamped region rests or moves as prescribed") {
    Rig<2> rig(solid_block(2, "", R"(clamped:
      - {shape: {type: half_space, point: [0.2, 0, 0], normal: [1, 0, 0]}}
      - {shape: {type: half_space, point: [0.6, 0, 0], normal: [-1, 0, 0]},
          motion: {displacement: [0.01*t, 0, 0]}})"));
    rig.plan_it();
    rig.stepper->run(0.05, {[] { return true; }});
    const auto& set = rig.world.set("solids");
    const double t = rig.world.clock.time;
    int held = 0, moved = 0;
    for (Index i = 0; i < set.size(); ++i) {
      const Vec<2> u = set.vector(fields::position)[i] - set.vector(fields::reference_position)[i];
      if (set.tag(fields::clamp)[i] == 0 && ++held) CHECK(u.norm() == 0);
      if (set.tag(fields::clamp)[i] == 1 && ++moved) CHECK(u[0] == doctest::Approx(0.01 * t));
    }
    CHECK(held == 14);
    CHECK(moved == 14);
  }
}
