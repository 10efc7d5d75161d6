// What probes of forces sum up to: in a closed tank, the impulse of walls and bodies is the change
// of momentum of what is in it.

#include <doctest/doctest.h>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "core/parallel.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// Walls of free slip, so that drag is pressure alone; a cylinder that is towed, and one that
// floats.
std::string closed_tank(const std::string& inside, const std::string& probes,
                        const std::string& numerics = "") {
  return fmt::format(R"(
dimension: 2
resolution: 0.02
end_time: 1
variables: {{R: 0.06}}
materials:
  - {{name: water, type: water, density: 1000, viscosity: 1e-3, max_speed: 3}}
  - {{name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1 MPa,
      friction_angle: 30 deg, hydraulic_conductivity: 0.01}}
  - {{name: wood, type: rigid, density: 600, stiffness: 1 MPa}}
{}
probes:
  - {{name: tank, type: force, boundary: tank}}
{}
numerics: {{{}}}
)",
                     inside, probes, numerics);
}

const char* const towed = R"(
bodies:
  - name: pool
    material: water
    pressure: hydrostatic
    shape: {type: difference, of: [{type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.4]},
        {type: cylinder, from: [0.25, -1, 0.2], to: [0.25, 1, 0.2], radius: R}]}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top], slip: free_slip}
  - {name: towed, type: wall, shape: {type: cylinder, from: [0.25, -1, 0.2], to: [0.25, 1, 0.2],
      radius: R}, motion: {displacement: ["t < 0.2 ? t*t : 0.4*t - 0.04", 0, 0]}}
)";

const char* const floating = R"(
bodies:
  - {name: pool, material: water, pressure: hydrostatic, level: 0.4, around: [log],
     shape: {type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.4]}}
  - {name: log, material: wood, velocity: [0.3, 0, 0],
     shape: {type: sphere, center: [0.5, 0, 0.2], radius: R}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top]}
)";

const char* const both = R"(
bodies:
  - {name: pool, material: water, pressure: hydrostatic, level: 0.4, around: [log],
     shape: {type: difference, of: [{type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.4]},
        {type: cylinder, from: [0.2, -1, 0.2], to: [0.2, 1, 0.2], radius: R}]}}
  - {name: log, material: wood, shape: {type: sphere, center: [0.55, 0, 0.2], radius: R}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top]}
  - {name: towed, type: wall, shape: {type: cylinder, from: [0.2, -1, 0.2], to: [0.2, 1, 0.2],
      radius: R}, motion: {displacement: ["t < 0.2 ? t*t : 0.4*t - 0.04", 0, 0]}}
)";

const char* const soil = R"(
bodies:
  - {name: bed, material: sand, stress: geostatic,
     shape: {type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.2]}}
  - {name: log, material: wood, shape: {type: sphere, center: [0.55, 0, 0.261], radius: R},
     velocity: [0, 0, -0.5]}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top],
     motion: {displacement: [0.004*sin(30*t), 0, 0]}}
)";

const char* const wet_soil = R"(
bodies:
  - {name: pool, material: water, pressure: hydrostatic, level: 0.4,
     shape: {type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.4]}}
  - {name: bed, material: sand, stress: geostatic,
     shape: {type: box, min: [0, 0, 0], max: [0.8, 0.1, 0.2]}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top],
     motion: {displacement: [0.004*sin(30*t), 0, 0]}}
relaxation: {steps: 100}
)";

struct Balance {
  Vec<2> momentum = Vec<2>::Zero();  ///< of the sets, kg m/s
  double mass = 0;
};

Balance balance_of(const World<2>& world, const std::vector<std::string>& sets) {
  Balance sum;
  for (const std::string& name : sets) {
    const ParticleSet<2>& set = *world.find(name);
    const auto& m = set.scalar(fields::mass);
    const auto& v = set.vector(fields::velocity);
    sum.mass += ordered_sum(set.size(), [&](Index i) { return m[i]; });
    sum.momentum += ordered_sum(set.size(), [&](Index i) -> Vec<2> { return m[i] * v[i]; });
  }
  return sum;
}

/// One probe's columns that are a force on the sets (-1 for a force by them).
struct Part {
  std::size_t probe, column;
  double sign;
};

/// Largest difference between impulse and change of momentum at any time, over the largest impulse
/// beyond that of the weight.
double worst_difference(Rig<2>& rig, const std::vector<std::string>& sets,
                        const std::vector<Part>& parts, double end) {
  rig.plan_it();
  const Balance before = balance_of(rig.world, sets);
  Vec<2> impulse = Vec<2>::Zero();
  double worst = 0, size = 0, last = 0;
  rig.stepper->run(end, {[&] {
                     const double t = rig.world.clock.time, dt = t - last;
                     last = t;
                     if (t == 0) return true;
                     for (const Part& p : parts) {
                       const auto out = rig.sample(p.probe);
                       impulse += p.sign * dt * Vec<2>(*out[p.column], *out[p.column + 1]);
                     }
                     impulse += dt * before.mass * rig.world.gravity();
                     const Vec<2> gained = balance_of(rig.world, sets).momentum - before.momentum;
                     worst = std::max(worst, (gained - impulse).norm());
                     size = std::max(size, gained.norm());
                     return true;
                   }});
  INFO("momentum gained up to ", size, " N s, difference up to ", worst);
  CHECK(size > 0.01);
  return worst / size;
}

const char* const log_force = "  - {name: log, type: body_force, body: log}\n";
const char* const towed_force = "  - {name: towed, type: force, boundary: towed}\n";

}  // namespace

TEST_SUITE("probes") {
  TEST_CASE("impulse of walls, one of them moving, is the momentum that water gains") {
    for (const char* by : {"summation", "shepard", "none"}) {
      CAPTURE(by);
      Rig<2> rig(closed_tank(towed, towed_force, std::string("density_reinitialization: ") + by));
      CHECK(worst_difference(rig, {"water"}, {{0, 0, -1}, {1, 0, -1}}, 0.3) < 1e-3);
    }
  }

  TEST_CASE("impulse of walls and a body is the momentum that water gains, and the body's") {
    {
      Rig<2> rig(closed_tank(floating, log_force));
      CHECK(worst_difference(rig, {"water"}, {{0, 0, -1}, {1, 0, -1}}, 0.3) < 1e-3);
    }
    Rig<2> rig(closed_tank(floating, log_force));
    CHECK(worst_difference(rig, {"solids"}, {{1, 0, 1}}, 0.3) < 1e-3);
  }

  TEST_CASE("impulse of walls, a moving wall and a body together") {
    Rig<2> rig(closed_tank(both, std::string(towed_force) + log_force));
    CHECK(worst_difference(rig, {"water"}, {{0, 0, -1}, {1, 0, -1}, {2, 0, -1}}, 0.3) < 1e-3);
  }

  TEST_CASE("impulse in soil: of a shaken tank and of a body that falls on it") {
    {
      Rig<2> rig(closed_tank(soil, log_force));
      CHECK(worst_difference(rig, {"soil"}, {{0, 0, -1}, {1, 3, -1}}, 0.1) < 1e-3);
    }
    Rig<2> rig(closed_tank(soil, log_force));
    CHECK(worst_difference(rig, {"solids"}, {{1, 3, 1}}, 0.1) < 1e-3);
  }

  TEST_CASE("impulse of a shaken tank on soil and its pore water") {
    Rig<2> rig(closed_tank(wet_soil, ""));
    CHECK(worst_difference(rig, {"water", "soil"}, {{0, 0, -1}}, 0.1) < 1e-2);
  }

  TEST_CASE("impulse of the contact of a body with a wall is its change of momentum") {
    Rig<2> rig(closed_tank(R"(
bodies:
  - {name: log, material: wood, shape: {type: box, min: [0.3, 0, 0.02], max: [0.5, 0, 0.12]},
     velocity: [0.5, 0, -1]}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0.1, 0.7], open: [top]}
)",
                           log_force));
    CHECK(worst_difference(rig, {"solids"}, {{1, 6, 1}}, 0.1) < 1e-3);
  }

  TEST_CASE("torque of still water on a wall is rho g H^3 / 6 about its foot") {
    Rig<2> rig(closed_tank(R"(
bodies:
  - {name: pool, material: water, pressure: hydrostatic,
     shape: {type: box, min: [0, 0, 0], max: [0.6, 0.1, 0.4]}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.6, 0.1, 0.7], open: [top, right]}
  - {name: plate, type: wall, shape: {type: box, min: [0.6, -1, -0.08], max: [0.68, 1, 0.7]}}
)",
                           "  - {name: foot, type: force, boundary: plate, about: [0.6, 0, 0]}\n"
                           "  - {name: high, type: force, boundary: plate, about: [0.6, 0, 1]}\n"));
    rig.plan_it();
    double torque = 0, high = 0, force = 0, time = 0, last = 0;
    rig.stepper->run(0.3, {[&] {
                       const double dt = rig.world.clock.time - last;
                       last = rig.world.clock.time;
                       if (last < 0.1) return true;
                       force += dt * *rig.sample(1)[0];
                       torque += dt * *rig.sample(1)[2];
                       high += dt * *rig.sample(2)[2];
                       time += dt;
                       return true;
                     }});
    const double gamma = 9810, depth = 0.4;
    CHECK(force / time == doctest::Approx(gamma * depth * depth / 2).epsilon(0.02));
    CHECK(torque / time == doctest::Approx(gamma * std::pow(depth, 3) / 6).epsilon(0.03));
    CHECK(high / time == doctest::Approx((torque - force) / time).epsilon(1e-9));
  }
}
