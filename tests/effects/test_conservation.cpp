// What pair sums may not change: momentum, mass, a uniform motion, action and reaction.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <set>

#include "core/parallel.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string free_body(const std::string& precision) {
  // A disc that is stirred and squeezed far from any wall.
  return fmt::format(R"(
dimension: 2
resolution: 0.025
gravity: 0
end_time: 1
materials: [{{name: water, type: water, density: 1000, viscosity: 1, sound_speed: 30}}]
bodies:
  - name: disc
    material: water
    shape: {{type: sphere, center: [0, 0, 0], radius: 0.4}}
    velocity: [2*z - x + 0.3, 0, -2*x + sin(9*z) - 0.2]
    pressure: 5e3*cos(3*x)
numerics: {{pair_precision: {}}}
)",
                     precision);
}

const char* const tank = R"(
dimension: 2
resolution: 0.025
gravity: 9.81
end_time: 1
materials: [{name: water, type: water, density: 1000, viscosity: 1e-3}]
bodies:
  - name: pool
    material: water
    shape: {type: difference, of: [{type: box, min: [0, 0, 0], max: [0.5, 0.1, 0.3]}, {type: box,
        min: [0.2, 0, 0], max: [0.3, 0.1, 0.1]}]}
    level: 0.3
    pressure: hydrostatic
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.1, 0.4], open: [top]}
  - {name: sill, type: wall, shape: {type: box, min: [0.2, 0, 0], max: [0.3, 0.1, 0.1]},
      slip: free_slip}
)";

Vec<2> momentum(const ParticleSet<2>& water) {
  const auto& m = water.scalar(fields::mass);
  const auto& v = water.vector(fields::velocity);
  return ordered_sum(water.size(), [&](Index i) -> Vec<2> { return m[i] * v[i]; });
}

// Change of momentum over 200 acoustic steps relative to the sum of m |v|.
double momentum_drift(const std::string& precision) {
  Rig<2> rig(free_body(precision));
  rig.plan_it();
  const Vec<2> before = momentum(rig.water());
  const auto& m = rig.water().scalar(fields::mass);
  const auto& v = rig.water().vector(fields::velocity);
  const double size = ordered_sum(m.size(), [&](Index i) { return m[i] * v[i].norm(); });
  rig.advance_acoustic(200);
  CHECK(rig.world.clock.acoustic_steps >= 200);
  return (momentum(rig.water()) - before).norm() / size;
}

// Sum of the forces of the walls on the water, and of the water on the walls.
std::pair<Vec<2>, Vec<2>> action_and_reaction(Rig<2>& rig) {
  rig.freeze();
  rig.apply("water_reaction");
  auto& sum = rig.water().vector(fields::acceleration_sum);
  for (Index i = 0; i < sum.size(); ++i) sum[i].setZero();
  rig.apply("water_wall_force");
  const auto& m = rig.water().scalar(fields::mass);
  const auto& force = rig.walls().vector(fields::water_force);
  return {ordered_sum(sum.size(), [&](Index i) -> Vec<2> { return m[i] * sum[i]; }),
          ordered_sum(force.size(), [&](Index i) -> Vec<2> { return force[i]; })};
}

const std::vector<Wish> wall_force{{"walls", "water_force", "the test", false}};

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("linear momentum of a free body stays") {
    const double full = momentum_drift("double"), single = momentum_drift("single");
    INFO("momentum drift over 200 acoustic steps: double ", full, ", single ", single);
    CHECK(full < 1e-12);
    CHECK(single < 1e-8);  // about 1e-9 was measured
  }

  TEST_CASE("mass is exact by count") {
    Rig<2> rig(free_body("single"));
    rig.plan_it();
    const Index n = rig.water().size();
    rig.advance_acoustic(60);
    REQUIRE(rig.water().size() == n);
    CHECK(rig.world.lost().at("water") == 0);
    std::set<Id> ids;
    for (Index i = 0; i < n; ++i) {
      ids.insert(rig.water().ids()[i]);
      CHECK(rig.water().scalar(fields::mass)[i] == 1000 * std::pow(0.025, 2));
    }
    CHECK(static_cast<Index>(ids.size()) == n);
    CHECK(*ids.rbegin() == static_cast<Id>(n - 1));
  }

  TEST_CASE("particles that leave the domain are counted, the others keep their ids") {
    Rig<2> rig(free_body("single"), {"numerics.domain_max=[0.3, 0, 5]"});
    const Index n = rig.water().size();
    std::set<Id> inside;
    for (Index i = 0; i < n; ++i)
      if (rig.water().vector(fields::position)[i].x() <= 0.3) inside.insert(rig.water().ids()[i]);
    rig.plan_it();
    REQUIRE(inside.size() < static_cast<std::size_t>(n));
    CHECK(rig.world.lost().at("water") == n - static_cast<Index>(inside.size()));
    std::set<Id> left;
    for (Index i = 0; i < rig.water().size(); ++i) left.insert(rig.water().ids()[i]);
    CHECK(left == inside);
    Rig<2> strict(free_body("single"),
                  {"numerics.domain_max=[0.3, 0, 5]", "numerics.outside=stop"});
    CHECK_THROWS_WITH_AS(strict.plan_it(), doctest::Contains("left the domain"),
                         std::runtime_error);
  }

  TEST_CASE("walls push the water as hard as the water pushes the walls") {
    for (const auto& [precision, tolerance] :
         {std::pair{"double", 1e-12}, std::pair{"single", 1e-5}}) {
      Rig<2> rig(tank, {std::string("numerics.pair_precision=") + precision,
                        "bodies[0].velocity=[2, 0, -1]"});
      rig.plan_it(wall_force);
      rig.advance(3);
      const auto [on_water, on_walls] = action_and_reaction(rig);
      INFO(std::string(precision), ": ", (on_water + on_walls).norm() / on_water.norm());
      CHECK(on_water.norm() > 100);
      CHECK((on_water + on_walls).norm() < tolerance * on_water.norm());
    }
  }

  TEST_CASE("the floor carries the weight of still water") {
    Rig<2> rig(tank);
    rig.plan_it(wall_force);
    const auto& m = rig.water().scalar(fields::mass);
    const double weight = 9.81 * ordered_sum(m.size(), [&](Index i) { return m[i]; });
    double low = 1e9, high = 0, sum = 0;
    long n = 0;
    rig.stepper->run(0.3, {[&] {
                       if (rig.world.clock.time < 0.1) return true;
                       const Vec<2> f = action_and_reaction(rig).second;
                       low = std::min(low, -f[1] / weight);
                       high = std::max(high, -f[1] / weight);
                       sum += -f[1] / weight;
                       ++n;
                       CHECK(std::abs(f[0]) < 0.05 * weight);
                       return true;
                     }});
    INFO("force on the floor / weight: ", low, " to ", high, ", mean ",
         sum / static_cast<double>(n));
    CHECK(sum / static_cast<double>(n) == doctest::Approx(1).epsilon(0.01));
    CHECK(low > 0.97);
    CHECK(high < 1.03);
  }

  TEST_CASE("a block in uniform motion keeps its density and velocity") {
    for (const auto& [precision, tolerance] :
         {std::pair{"double", 1e-12}, std::pair{"single", 1e-6}}) {
      Rig<2> rig(free_body(precision),
                 {"bodies[0].velocity=[1, 0, 0.5]", "bodies[0].pressure=zero",
                  "bodies[0].shape={type: box, min: [0, 0, 0], max: [0.5, 0, 0.5]}",
                  "numerics.transport_velocity=false"});
      rig.plan_it();
      rig.advance_acoustic(200);
      double off = 0, off_density = 0;
      for (Index i = 0; i < rig.water().size(); ++i) {
        off = std::max(off, (rig.water().vector(fields::velocity)[i] - Vec<2>(1, 0.5)).norm());
        off_density =
            std::max(off_density, std::abs(rig.water().scalar(fields::density)[i] / 1000 - 1));
      }
      INFO(std::string(precision), ": velocity ", off, " m/s, density ", off_density);
      CHECK(off < tolerance * 30);  // in terms of the speed of sound
      CHECK(off_density < tolerance);
    }
  }
}
