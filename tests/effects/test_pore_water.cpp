// Water in soil: what it may not change (momentum, a common motion), and what it must give (drag,
// buoyancy, fractions).

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/hash.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

double random(Index i, int k) {
  return 2 * random_uniform(31, static_cast<std::uint64_t>(16 * i + k)) - 1;
}

// Water and soil that overlap, with a porosity that varies, far from walls. The soil's stress stays
// zero.
std::string block(int dimension, const std::string& soil, const std::string& more = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials:
  - {{name: water, type: water, density: 1000, viscosity: 0, sound_speed: 30}}
  - {{name: soil, type: soil, density: 2600, youngs_modulus: 1e5, plasticity: none, {}}}
bodies:
  - {{name: water, material: water, shape: {{type: box, min: [0, 0, 0], max: [0.9, 0.8, 1.2]}}}}
  - {{name: soil, material: soil, shape: {{type: box, min: [0, 0, 0], max: [0.9, 0.8, 0.8]}},
      volume_fraction: 0.5 + 0.15*sin(3*x)*cos(2*z)}}
relaxation: {{steps: 30}}
{})",
                     dimension, soil, more);
}

const char* const exact = "numerics: {pair_precision: double}";

template <int Dim>
Vec<Dim> momentum(const ParticleSet<Dim>& set) {
  const auto& m = set.scalar(fields::mass);
  const auto& v = set.vector(fields::velocity);
  return ordered_sum(set.size(), [&](Index i) -> Vec<Dim> { return m[i] * v[i]; });
}

// Momentum after n acoustic steps from random velocities and densities, over the sum of m |v|.
template <int Dim>
double drift(const std::string& soil, const std::string& numerics, int n) {
  Rig<Dim> rig(block(Dim, soil, numerics));
  double size = 0;
  for (const char* name : {"water", "soil"}) {
    ParticleSet<Dim>& set = rig.world.set(name);
    for (Index i = 0; i < set.size(); ++i) {
      for (int k = 0; k < Dim; ++k)
        set.vector(fields::velocity)[i][k] = 0.3 * random(i, k + (name[0] == 'w' ? 0 : 5));
      size += set.scalar(fields::mass)[i] * set.vector(fields::velocity)[i].norm();
      if (name[0] == 'w') set.scalar(fields::density)[i] = 1000 * (1 + 0.01 * random(i, 9));
    }
  }
  rig.plan_it();
  const Vec<Dim> before = momentum(rig.water()) + momentum(rig.soil());
  rig.advance_acoustic(n);
  return (momentum(rig.water()) + momentum(rig.soil()) - before).norm() / size;
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("water and soil exchange momentum and make none") {
    CHECK(drift<2>("grain_size: 2e-3", exact, 60) < 1e-13);
    CHECK(drift<2>("hydraulic_conductivity: 1e-9", exact, 60) < 1e-13);
    CHECK(drift<2>("drag: none", exact, 60) < 1e-13);
    CHECK(drift<3>("grain_size: 2e-3", exact, 20) < 1e-13);
    CHECK(drift<2>("grain_size: 2e-3", "", 60) < 1e-5);
  }

  TEST_CASE("water and soil that move together stay as they are") {
    Rig<2> rig(block(2, "grain_size: 2e-3",
                     "numerics: {pair_precision: double, density_reinitialization: none, "
                     "transport_velocity: false}"));
    for (const char* name : {"water", "soil"})
      for (Index i = 0; i < rig.world.set(name).size(); ++i)
        rig.world.set(name).vector(fields::velocity)[i] = Vec<2>(3.0, -2.0);
    rig.plan_it();
    rig.advance_acoustic(100);
    double density = 0, speed = 0;
    for (Index i = 0; i < rig.water().size(); ++i) {
      density = std::max(density, std::abs(rig.water().scalar(fields::density)[i] / 1000 - 1));
      speed = std::max(speed, (rig.water().vector(fields::velocity)[i] - Vec<2>(3, -2)).norm());
    }
    CHECK(density < 1e-12);
    CHECK(speed < 1e-10);
  }

  TEST_CASE("drag takes energy, however stiff it is") {
    for (const char* soil : {"hydraulic_conductivity: 1e-2", "hydraulic_conductivity: 1e-9",
                             "grain_size: 1e-6", "grain_size: 0.1"}) {
      Rig<2> rig(block(2, soil, exact));
      for (Index i = 0; i < rig.water().size(); ++i)
        for (int k = 0; k < 2; ++k) rig.water().vector(fields::velocity)[i][k] = random(i, k);
      rig.plan_it();
      rig.world.clock.dt_acoustic = 1e-3;
      const auto kinetic = [&](double dt) {
        double sum = 0;
        for (const char* name : {"water", "soil"}) {
          ParticleSet<2>& set = rig.world.set(name);
          for (Index i = 0; i < set.size(); ++i)
            sum += 0.5 * set.scalar(fields::mass)[i] *
                   (set.vector(fields::velocity)[i] + dt * set.vector(fields::acceleration_sum)[i])
                       .squaredNorm();
        }
        return sum;
      };
      for (const char* name : {"water", "soil"}) {
        auto& a = rig.world.set(name).vector(fields::acceleration_sum);
        for (Index i = 0; i < a.size(); ++i) a[i].setZero();
      }
      const double before = kinetic(0);
      rig.apply("drag");
      CAPTURE(soil);
      CHECK(kinetic(1e-3) <= before);
    }
  }

  TEST_CASE("the water fraction is the prescribed one down to the walls") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.025
gravity: 9.81
end_time: 1
materials:
  - {name: water, type: water, density: 1000, viscosity: 1e-3}
  - {name: soil, type: soil, density: 2650, volume_fraction: 0.6, youngs_modulus: 1e7,
      friction_angle: 30 deg, skeleton: fixed, grain_size: 5e-3}
bodies:
  - {name: water, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.5]},
      pressure: hydrostatic}
  - {name: soil, material: soil, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.6]}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.1, 0.7], open: [top]}
)");
    rig.plan_it({{"soil", "saturation", "the test", false}});
    for (Index i = 0; i < rig.water().size(); ++i)
      CHECK(rig.water().scalar(fields::water_fraction)[i] == doctest::Approx(0.4).epsilon(0.02));
    for (Index k = 0; k < rig.soil().size(); ++k)
      if (rig.soil().vector(fields::position)[k][1] < 0.4)
        CHECK(rig.soil().scalar(fields::saturation)[k] == doctest::Approx(1).epsilon(0.05));
  }

  TEST_CASE("soil in still water weighs less by the water it displaces") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.025
gravity: 9.81
end_time: 1
materials:
  - {name: water, type: water, density: 1000, viscosity: 0}
  - {name: soil, type: soil, density: 2650, volume_fraction: 0.6, youngs_modulus: 1e7,
      friction_angle: 30 deg, grain_size: 5e-3}
bodies:
  - {name: water, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.7]},
      pressure: hydrostatic}
  - {name: soil, material: soil, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.4]}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.1, 0.8], open: [top]}
numerics: {pair_precision: double, density_reinitialization: none, transport_velocity: false}
)");
    rig.plan_it();
    rig.advance(1500);  // until water and soil have come to rest from the first, uneven pushes
    // All of the soil: what the water lifts of it is rho^w g times the volume of its grains.
    double lift = 0, grains = 0;
    for (Index k = 0; k < rig.soil().size(); ++k) {
      lift +=
          rig.soil().scalar(fields::mass)[k] * rig.soil().vector(fields::water_acceleration)[k][1];
      grains += rig.soil().scalar(fields::mass)[k] / 2650;
    }
    CHECK(lift == doctest::Approx(1000 * 9.81 * grains).epsilon(0.02));
  }

  TEST_CASE("water of variable mass has the mass of the pores, on a lattice") {
    Rig<2> equal(block(2, "grain_size: 2e-3")),
        variable(block(2, "grain_size: 2e-3", "numerics: {pore_water: variable_mass}"));
    const auto mass = [](Rig<2>& rig) {
      const auto& m = rig.water().scalar(fields::mass);
      return ordered_sum(m.size(), [&](Index i) { return m[i]; });
    };
    CHECK(variable.water().size() == 9 * 12);
    CHECK(std::abs(mass(variable) - mass(equal)) <= 1000 * 0.1 * 0.1);
    for (Index i = 0; i < variable.water().size(); ++i)
      CHECK(variable.water().scalar(fields::mass)[i] <= 10 * (1 + 1e-12));
  }

  TEST_CASE("the density filter keeps a linear density, and takes out what goes up and down") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.1
gravity: 0
end_time: 1
materials: [{name: water, type: water, density: 1000, viscosity: 0, sound_speed: 30}]
bodies: [{name: block, material: water, shape: {type: box, min: [0, 0, 0], max: [1.2, 0.8, 1]}}]
numerics: {pair_precision: double, density_reinitialization: shepard, transport_velocity: false}
)");
    rig.jitter(0.2);
    const auto linear = [&](Index i) {
      return 1000 + 3 * rig.water().vector(fields::position)[i][0] -
             2 * rig.water().vector(fields::position)[i][1];
    };
    auto& rho = rig.water().scalar(fields::density);
    for (Index i = 0; i < rho.size(); ++i) rho[i] = linear(i);
    rig.plan_it();
    double off = 0;
    for (Index i = 0; i < rho.size(); ++i) off = std::max(off, std::abs(rho[i] - linear(i)));
    CHECK(off < 1e-9);
    for (Index i = 0; i < rho.size(); ++i) rho[i] = linear(i) + random(i, 3);
    rig.apply("density_filter");
    double noise = 0;
    for (Index i = 0; i < rho.size(); ++i) noise += std::pow(rho[i] - linear(i), 2);
    CHECK(std::sqrt(noise / static_cast<double>(rho.size())) < 0.35);  // of 0.58 before
  }
}
