#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <cmath>

#include "core/hash.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

/// A solid block in the middle of water, of soil, or of both; nothing holds it.
std::string scene(int dimension, bool water, bool soil, const std::string& solid,
                  const std::string& numerics) {
  const std::string around =
      "{type: difference, of: [{type: box, min: [0, 0, 0], max: [1, 1, 1]}, {type: box, min: [0.3, "
      "0.3, 0.3], max: [0.6, 0.7, 0.7]}]}";
  return fmt::format(
      R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials:
  - {{name: water, type: water, sound_speed: 20, viscosity: 2}}
  - {{name: sand, type: soil, density: 2000, volume_fraction: 0.6, youngs_modulus: 1e6,
      friction_angle: 30 deg, grain_size: 0.01}}
  - {}
bodies:
  - {{name: block, material: rock, spacing: 0.05, shape: {{type: box, min: [0.3, 0.3, 0.3],
      max: [0.6, 0.7, 0.7]}}}}
{}{}relaxation: {{steps: 3}}
numerics: {{outside: stop{}}}
)",
      dimension, solid, water ? "  - {name: pool, material: water, shape: " + around + "}\n" : "",
      soil ? "  - {name: bed, material: sand, shape: " + around + "}\n" : "", numerics);
}

const std::string elastic = "{name: rock, type: elastic, density: 2500, youngs_modulus: 1e6}";
const std::string rigid = "{name: rock, type: rigid, density: 2500}";

template <int Dim>
void stir(Rig<Dim>& rig) {
  for (const auto& set : rig.world.sets()) {
    if (set->phase() == "wall") continue;
    auto& v = set->vector(fields::velocity);
    for (Index i = 0; i < set->size(); ++i)
      for (int k = 0; k < Dim; ++k)
        v[i][k] = set->phase() == "solid"
                      ? 0.1 * (k + 1)
                      : 2 * random_uniform(7, static_cast<std::uint64_t>(Dim * i + k)) - 1;
    if (set->name() == "water")
      for (Index i = 0; i < set->size(); ++i)
        set->scalar(fields::density)[i] *=
            1 + 0.01 * random_uniform(5, static_cast<std::uint64_t>(i));
    if (set->name() == "soil")
      for (Index i = 0; i < set->size(); ++i)
        for (int k = 0; k < 3; ++k)
          set->tensor(fields::stress)[i][k] =
              -1e3 * random_uniform(4, static_cast<std::uint64_t>(3 * i + k));
  }
}

template <int Dim>
Vec<Dim> momentum(const Rig<Dim>& rig) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const auto& set : rig.world.sets())
    if (set->phase() != "wall")
      for (Index i = 0; i < set->size(); ++i)
        sum += set->scalar(fields::mass)[i] * set->vector(fields::velocity)[i];
  return sum;
}

/// Momentum before and after some whole steps, over what a set exchanged with the block.
template <int Dim>
void check_exchange(bool water, bool soil, const std::string& solid, const std::string& numerics,
                    double tolerance) {
  Rig<Dim> rig(scene(Dim, water, soil, solid, numerics));
  stir(rig);
  rig.plan_it();
  const Vec<Dim> before = momentum(rig);
  int steps = 0;
  double exchanged = 0;
  rig.stepper->run(1.0, {[&] {
                     const auto& solids = rig.world.set("solids");
                     if (steps > 0)
                       for (Index i = 0; i < solids.size(); ++i)
                         exchanged += solids.vector(fields::fluid_force)[i].norm() *
                                      rig.world.clock.dt_acoustic;
                     return steps++ < 2;
                   }});
  CHECK(exchanged > 0);
  CHECK((momentum(rig) - before).norm() < tolerance * exchanged);
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("what water and soil lose to a solid, the solid gains") {
    const std::string exact = ", pair_precision: double";
    for (const std::string& solid : {elastic, rigid}) {
      CAPTURE(solid);
      check_exchange<2>(true, false, solid, exact, 1e-11);
      check_exchange<3>(true, false, solid, exact, 1e-11);
      check_exchange<2>(false, true, solid, exact, 1e-11);
      check_exchange<3>(false, true, solid, exact, 1e-11);
      check_exchange<2>(true, false, solid, "", 1e-4);
      check_exchange<3>(false, true, solid, "", 1e-4);
    }
  }

  TEST_CASE("a rigid body keeps its shape and its angular momentum") {
    Rig<3> rig(R"(
dimension: 3
resolution: 0.1
gravity: 0
end_time: 10
materials: [{name: rock, type: rigid, density: 2500}]
bodies:
  - name: block
    material: rock
    shape: {type: box, min: [-0.2, -0.3, -0.5], max: [0.2, 0.3, 0.5]}
    velocity: ["1 + 2*z - 0.5*y", "0.5*x - 3*z", "3*y - 2*x"]
)");
    rig.plan_it();
    const auto spin = [&] {
      const auto& set = rig.world.set("solids");
      Vec3 sum = Vec3::Zero(), center = Vec3::Zero();
      double mass = 0;
      for (Index i = 0; i < set.size(); ++i) {
        mass += set.scalar(fields::mass)[i];
        center += set.scalar(fields::mass)[i] * set.vector(fields::position)[i];
      }
      center /= mass;
      for (Index i = 0; i < set.size(); ++i)
        sum += set.scalar(fields::mass)[i] *
               (set.vector(fields::position)[i] - center).cross(set.vector(fields::velocity)[i]);
      return sum;
    };
    const Vec3 before = spin();
    int steps = 0;
    rig.stepper->run(10.0, {[&] { return steps++ < 100; }});
    CHECK((spin() - before).norm() < 1e-10 * before.norm());
    const auto& set = rig.world.set("solids");
    for (Index i = 0; i < set.size(); ++i) {
      const double now = (set.vector(fields::position)[i] - set.vector(fields::position)[0]).norm();
      const double rest =
          (set.vector(fields::reference_position)[i] - set.vector(fields::reference_position)[0])
              .norm();
      CHECK(now == doctest::Approx(rest).epsilon(1e-11));
    }
    CHECK((set.vector(fields::position)[0] - set.vector(fields::reference_position)[0]).norm() >
          0.1);
  }

  TEST_CASE("a contact pushes both bodies alike, and bodies that start close are at ease") {
    const std::string two = R"(
dimension: 2
resolution: 0.1
gravity: 0
end_time: 1
materials: [{name: rubber, type: elastic, density: 1000, youngs_modulus: 1e6, friction: 0.5,
    contact_damping: 0.3}]
bodies:
  - {name: left, material: rubber, velocity: [0.5, 0, 0.2], shape: {type: box, min: [-0.6, 0, 0],
      max: [0, 1, 0.6]}}
  - {name: right, material: rubber, velocity: [-0.5, 0, 0], shape: {type: box, min: [GAP, 0, 0],
      max: [0.6, 1, 0.6]}}
numerics: {pair_precision: double}
)";
    const auto with_gap = [&](const char* gap) {
      std::string deck = two;
      return deck.replace(deck.find("GAP"), 3, gap);
    };
    Rig<2> rig(with_gap("0"));
    rig.plan_it();
    const Vec<2> before = momentum(rig);
    // Touching at the start: nothing pushes until they move.
    rig.world.clock.dt_solid = 0;
    rig.plan->run(Stage::solid_predict);
    rig.plan->run(Stage::solid_force);
    const auto& f = rig.world.set("interface").vector(fields::contact_force);
    for (Index i = 0; i < f.size(); ++i) CHECK(f[i].norm() < 1e-30);
    double most = 0;
    int steps = 0;
    rig.stepper->run(1.0, {[&] {
                       for (Index i = 0; i < f.size(); ++i) most = std::max(most, f[i].norm());
                       return steps++ < 60;
                     }});
    CHECK(most > 0);
    CHECK((momentum(rig) - before).norm() < 1e-12 * 1000 * 0.72 * 0.5);
    // They did not pass through each other.
    const auto& set = rig.world.set("solids");
    double left = -1, right = 1;
    for (Index i = 0; i < set.size(); ++i) {
      if (set.tag(fields::part)[i] == 0) left = std::max(left, set.vector(fields::position)[i][0]);
      else right = std::min(right, set.vector(fields::position)[i][0]);
    }
    CHECK(right - left > 0.05);
  }
}
