// Probes against what a scene of known content must give: pore water, boundaries, bodies, paths.
// share/doc/probes.md names these tests.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// A pool that is saturated soil, porosity 0.4, in its lower half.
std::string pores(const std::string& probes, const std::string& velocity = "[0, 0, 0]") {
  return fmt::format(R"(
dimension: 2
resolution: 0.025
end_time: 1
materials:
  - {{name: water, type: water, sound_speed: 50}}
  - {{name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e7,
      friction_angle: 30 deg, skeleton: fixed, drag: none}}
bodies:
  - {{name: pool, material: water, velocity: {},
     shape: {{type: box, min: [0, 0, 0], max: [1, 0, 0.8]}}}}
  - {{name: plug, material: sand, shape: {{type: box, min: [0, 0, 0], max: [1, 0, 0.4]}}}}
boundaries: [{{name: tank, type: tank, min: [0, 0, 0], max: [1, 0, 1], open: [top]}}]
relaxation: {{steps: 200}}
probes:
{})",
                     velocity, probes);
}

}  // namespace

TEST_SUITE("probes") {
  TEST_CASE("water in pores: amount, energy, fraction, pressure and level") {
    Rig<2> rig(pores(
        "  - {name: a, type: amount}\n"
        "  - {name: e, type: energy}\n"
        "  - {name: n, type: mean, field: water_fraction, region: {type: box, min: [0.2, -1, "
        "0.1], max: [0.8, 1, 0.3]}}\n"
        "  - {name: low, type: pressure, at: [0.5, 0, 0.2]}\n"
        "  - {name: high, type: pressure, at: [0.5, 0, 0.6]}\n"
        "  - {name: level, type: water_level, at: [0.5, 0, 0]}\n"
        "  - {name: pore, type: mean, set: soil, field: pore_pressure, region: {type: box, min: "
        "[0.2, -1, 0.1], max: [0.8, 1, 0.3]}}\n"
        "  - {name: difference, type: sum, of: [low, high], factors: [1, -1]}\n",
        "[2, 0, 0]"));
    rig.plan_it();
    // Hydrostatic by the density of each particle; pressures are then those of the moment.
    const double gamma = 9810, c2 = 2500;
    for (Index i = 0; i < rig.water().size(); ++i) {
      const double p = gamma * (0.8 - rig.water().vector(fields::position)[i][1]);
      rig.water().scalar(fields::density)[i] = 1000 + p / c2;
    }
    rig.freeze();
    rig.plan->run(Stage::observe);
    if (rig.water().has(fields::mean_pressure))
      for (Index i = 0; i < rig.water().size(); ++i)
        rig.water().scalar(fields::mean_pressure)[i] = rig.water().scalar(fields::pressure)[i];
    rig.world.clock.time = 1;
    const double mass = 1000 * (0.4 + 0.4 * 0.4);
    const auto a = rig.sample(0);
    CHECK(*a[0] == doctest::Approx(mass).epsilon(0.01));
    CHECK(*a[1] == doctest::Approx(0.8).epsilon(0.01));  // of the mixture
    CHECK(*a[3] == doctest::Approx(mass / 1000).epsilon(0.01));
    const auto e = rig.sample(1);
    CHECK(*e[0] == doctest::Approx(0.5 * mass * 4).epsilon(0.01));
    CHECK(*e[1] == doctest::Approx(9810 * (0.4 * 0.6 + 0.16 * 0.2)).epsilon(0.01));
    CHECK(*rig.sample(2)[0] == doctest::Approx(0.4).epsilon(0.01));
    CHECK(*rig.sample(3)[0] == doctest::Approx(gamma * 0.6).epsilon(1e-6));
    CHECK(*rig.sample(4)[0] == doctest::Approx(gamma * 0.2).epsilon(1e-6));
    CHECK(std::abs(*rig.sample(5)[0] - 0.8) < 0.2 * 0.025);
    CHECK(*rig.sample(6)[0] == doctest::Approx(gamma * 0.6).epsilon(0.01));
    CHECK(*rig.sample(7)[0] == doctest::Approx(gamma * 0.4).epsilon(1e-6));
  }

  TEST_CASE("what has crossed boundaries: count and mass") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.05
end_time: 1
gravity: 0
numerics: {domain_min: [-20, -20, -20], domain_max: [20, 20, 20]}
materials: [{name: water, type: water, sound_speed: 20}]
boundaries:
  - {name: cloud, type: inlet, min: [0, 0, 1], max: [0.5, 0, 1], velocity: [0, 0, -1]}
  - {name: drain, type: outlet,
     shape: {type: box, min: [-1, 0, -1], max: [2, 0, 0.3]}}
probes:
  - {name: in, type: exchange, boundary: cloud}
  - {name: out, type: exchange, boundary: drain}
  - {name: net, type: sum, of: [in, out]}
)");
    rig.plan_it();
    rig.stepper->run(1.5, {[] { return true; }});
    const double way = rig.world.clock.time, row = 10, each = 1000 * 0.05 * 0.05;
    const auto in = rig.sample(0), out = rig.sample(1), net = rig.sample(2);
    CHECK(std::abs(*in[0] - row * way / 0.05) <= row);
    CHECK(*in[1] == 0.0);
    CHECK(*in[2] == doctest::Approx(*in[0] * each));
    CHECK(std::abs(*out[1] - row * (way - 0.7) / 0.05) <= 2 * row);
    CHECK(*out[2] == doctest::Approx(-*out[1] * each));
    CHECK(*net[2] == doctest::Approx(each * static_cast<double>(rig.water().size())));
  }

  TEST_CASE("a point on a deformation path: elastic moduli, and the strength in shear") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.05
end_time: 1
materials:
  - {name: clay, type: soil, density: 2000, volume_fraction: 1, youngs_modulus: 10 MPa,
     poisson_ratio: 0.25, friction_angle: 0 deg, cohesion: 20 kPa}
bodies: [{name: b, material: clay, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.5]}}]
probes:
  - {name: squeeze, type: stress_path, material: clay, path: oedometric, rate: 0.001, step: 0.01}
  - {name: shear, type: stress_path, material: clay, path: simple_shear, rate: 0.1, step: 1e-3}
)");
    rig.plan_it();
    rig.world.clock.time = 1;
    const auto squeeze = rig.sample(0);
    const double oedometric = 10e6 * 0.75 / (1.25 * 0.5);  // E (1 - nu) / ((1 + nu)(1 - 2 nu))
    CHECK(*squeeze[2] == doctest::Approx(-0.001 * oedometric).epsilon(0.01));
    CHECK(*squeeze[0] == doctest::Approx(*squeeze[2] / 3).epsilon(0.01));           // nu / (1 - nu)
    CHECK(*squeeze[6] == doctest::Approx(0.001 * 10e6 / (3 * 0.5)).epsilon(0.01));  // K strain
    CHECK(*squeeze[9] == 0.0);
    const auto shear = rig.sample(1);
    CHECK(*shear[7] == doctest::Approx(20e3).epsilon(0.01));  // sqrt(J2) = c where phi = 0
    CHECK(*shear[9] > 0.01);
    CHECK(*shear[10] == doctest::Approx(20e3 * (0.1 - 20e3 / 4e6)).epsilon(0.03));  // c gamma_p
  }

  TEST_CASE("force and torque on a body: Archimedes, and a couple") {
    const std::string deck = R"(
dimension: 2
resolution: 0.02
end_time: 1
materials:
  - {name: water, type: water, density: 1000, sound_speed: 30}
  - {name: stone, type: rigid, density: 1000}
bodies:
  - {name: pool, material: water, pressure: hydrostatic, level: 0.6, around: [stone],
     shape: {type: box, min: [0, 0, 0], max: [0.8, 0, 0.6]}}
  - {name: stone, material: stone, shape: {type: box, min: [0.3, 0, 0.2], max: [0.5, 0, 0.36]}}
boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0, 0.8], open: [top]}]
probes: [{name: f, type: body_force, body: stone}]
)";
    Rig<2> rig(deck);
    rig.plan_it();
    CHECK_FALSE(rig.sample(0)[0].has_value());  // before the first step there is no mean
    double lift = 0, torque = 0, last = 0, time = 0;
    rig.stepper->run(0.3, {[&] {
                       const double dt = rig.world.clock.time - last;
                       last = rig.world.clock.time;
                       if (last < 0.05) return true;
                       lift += dt * *rig.sample(0)[1];
                       torque += dt * *rig.sample(0)[2];
                       time += dt;
                       return true;
                     }});
    const double weight = 9810 * 0.2 * 0.16;
    CHECK(lift / time == doctest::Approx(weight).epsilon(0.02));
    CHECK(std::abs(torque / time) < 0.01 * weight * 0.2);
    // f = w (z, -x) from the centre: torque about y is w times the sum of squared distances.
    auto& interface = rig.world.set("interface");
    auto& f = interface.vector(fields::mean_water_force);
    const auto& x = interface.vector(fields::position);
    const auto& solid = rig.world.set("solids");
    Vec<2> center = Vec<2>::Zero();
    for (Index i = 0; i < solid.size(); ++i) center += solid.vector(fields::position)[i];
    center /= static_cast<double>(solid.size());
    double squares = 0;
    for (Index i = 0; i < interface.size(); ++i) {
      const Vec<2> r = x[i] - center;
      f[i] = 3 * Vec<2>(r[1], -r[0]);
      squares += r.squaredNorm();
    }
    CHECK(*rig.sample(0)[2] == doctest::Approx(3 * squares).epsilon(1e-9));
  }
}
