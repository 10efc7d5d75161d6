#include <doctest/doctest.h>

#include <limits>
#include <set>

#include "core/error.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// Water in sand, water beside it, a block of rubber above both, walls at rest.
const std::string all_phases = R"(
dimension: 2
resolution: 0.1
gravity: 9.81
end_time: 1
materials:
  - {name: water, type: water, sound_speed: 20}
  - {name: sand, type: soil, density: 2650, volume_fraction: 0.6, youngs_modulus: 1e6,
      friction_angle: 30 deg, grain_size: 0.01}
  - {name: rubber, type: elastic, density: 1000, youngs_modulus: 1e5}
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 0.5, 0.5]},
      pressure: hydrostatic}
  - {name: bed, material: sand, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.5, 0.3]}}
  - {name: block, material: rubber, shape: {type: box, min: [0.6, 0, 0.5], max: [0.9, 0.5, 0.8]}}
boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.5, 1], open: [top]}]
)";

/// What the guard says to one advection step; nullopt when it says nothing.
std::optional<Instability> verdict(Rig<2>& rig, std::string* sentence = nullptr) {
  try {
    rig.advance(1);
  } catch (const UnstableError& e) {
    if (sentence) *sentence = e.what();
    return e.instability;
  }
  return std::nullopt;
}

/// Puts the value into one particle's last component.
void plant(ParticleSet<2>& set, const FieldSpec& spec, Index i, double odd) {
  if (spec.type == FieldType::scalar) set.scalar(spec)[i] = odd;
  if (spec.type == FieldType::vector) set.vector(spec)[i][1] = odd;
  if (spec.type == FieldType::tensor) set.tensor(spec)[i][2] = odd;
}

bool holds_numbers(const FieldSpec& spec) {
  return spec.type == FieldType::scalar || spec.type == FieldType::vector ||
         spec.type == FieldType::tensor;
}

}  // namespace

TEST_SUITE("solve") {
  TEST_CASE(
      "with all phases, a value that is no number is caught in the same advection step, or is gone "
      "before it was used") {
    Rig<2> model(all_phases);
    model.plan_it();
    std::set<std::string> sets_caught;
    int planted = 0;
    for (const auto& set : model.world.sets())
      for (const auto& [name, field] : set->fields()) {
        if (field->spec().lifetime == Lifetime::derived || !holds_numbers(field->spec())) continue;
        for (const double odd :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
          Rig<2> rig(all_phases);
          rig.plan_it();
          rig.advance(2);
          ParticleSet<2>& victim = rig.world.set(set->name());
          plant(victim, field->spec(), victim.size() / 2, odd);
          ++planted;
          CAPTURE(set->name());
          CAPTURE(name);
          CAPTURE(odd);
          std::string sentence;
          const auto found = verdict(rig, &sentence);
          CAPTURE(sentence);
          if (found) {
            CHECK(found->cause == "not_finite");
            sets_caught.insert(set->name());
            // Such a state is never kept: this is what a checkpoint asks first.
            CHECK_THROWS_AS(rig.stepper->guard().check_all(), UnstableError);
          } else if (rig.world.moves(set->name())) {
            CHECK_NOTHROW(rig.stepper->guard().check_all());
          } else {
            // Of a set at rest nobody reads it; before a checkpoint it is found.
            CHECK_THROWS_AS(rig.stepper->guard().check_all(), UnstableError);
          }
        }
      }
    CHECK(planted >= 60);
    for (const char* set : {"water", "soil", "solids", "interface"})
      CHECK_MESSAGE(sets_caught.count(set) == 1, set);
  }

  TEST_CASE(
      "soil and solids that are faster than sound stop the run within the step, and who they are "
      "is said") {
    for (const char* name : {"soil", "solids"}) {
      CAPTURE(name);
      Rig<2> rig(all_phases);
      rig.plan_it();
      rig.advance(1);
      ParticleSet<2>& set = rig.world.set(name);
      set.vector(fields::velocity)[1] = Vec<2>(0, 500);
      const Id who = set.ids()[1];
      const long before = rig.world.clock.advection_steps;
      const auto found = verdict(rig);
      REQUIRE(found);
      CHECK(found->cause == "speed");
      CHECK(found->set == name);
      CHECK(found->particle == who);
      CHECK(found->effect == (std::string(name) == "soil" ? "soil_kick" : "solid_kick"));
      CHECK(rig.world.clock.advection_steps <= before + 1);
      CHECK_THROWS_AS(rig.stepper->guard().check_all(), UnstableError);
    }
  }

  TEST_CASE(
      "a step of solids that collapses stops the run, before it is cut into a thousand million "
      "parts") {
    Rig<2> rig(all_phases);
    rig.plan_it();
    rig.advance(1);
    StepLimits limits = rig.plan->limits();
    Guard<2>& guard = rig.stepper->guard();
    const double dt = limits.acoustic;
    guard.before_step(limits, dt);
    for (const double odd : {1e-5 * limits.solid, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
      CAPTURE(odd);
      StepLimits worse = limits;
      worse.solid = odd;
      CHECK_THROWS_WITH_AS(guard.before_step(worse, dt),
                           doctest::Contains("the solid step collapsed"), UnstableError);
    }
    // The real thing: an acceleration that is a number and lets no step be long enough.
    rig.world.set("solids").vector(fields::acceleration)[0] = Vec<2>(1e30, 0);
    const auto found = verdict(rig);
    REQUIRE(found);
    CHECK(found->cause == "step");
  }

  TEST_CASE("a volume fraction out of bounds stops the run") {
    for (const double odd : {-0.01, 4.01}) {
      CAPTURE(odd);
      Rig<2> rig(all_phases);
      rig.plan_it();
      rig.advance(1);
      rig.soil().scalar(fields::volume_fraction)[2] = odd;
      try {
        rig.stepper->guard().after_advection();
        FAIL("not stopped");
      } catch (const UnstableError& e) {
        CHECK(e.instability.cause == "volume_fraction");
        CHECK(e.instability.set == "soil");
        CHECK(e.instability.particle == rig.soil().ids()[2]);
        // Too much of it is compression; less than none is not.
        const std::string cause = odd < 0 ? "comes apart" : "youngs_modulus";
        CHECK(std::string(e.what()).find(cause) != std::string::npos);
      }
      CHECK_THROWS_AS(rig.stepper->guard().check_all(), UnstableError);
    }
  }

  TEST_CASE("a particle that goes wrong inside of a wall: the wall is named, and no other guess") {
    Rig<2> rig(all_phases);
    rig.plan_it();
    rig.advance(1);
    rig.soil().vector(fields::position)[2] = Vec<2>(0.5, -0.17);
    rig.soil().scalar(fields::volume_fraction)[2] = -0.01;
    CHECK_THROWS_WITH_AS(rig.stepper->guard().after_advection(),
                         doctest::Contains("it lies inside of boundary"), UnstableError);
  }

  TEST_CASE("the largest Mach number of water is kept beside that of all sets") {
    Rig<2> rig(all_phases);
    rig.plan_it();
    Guard<2>& guard = rig.stepper->guard();
    StepLimits limits = rig.plan->limits();
    limits.mach = 0.8;  // of soil
    limits.water_mach = 0.4;
    rig.world.clock.time = 0.25;
    guard.before_step(limits, limits.acoustic);
    limits.water_mach = 0.2;
    rig.world.clock.time = 0.5;
    guard.before_step(limits, limits.acoustic);
    const auto all = guard.extremes();
    const std::map<std::string, double> seen(all.begin(), all.end());
    CHECK(seen.at("max_mach") == 0.8);
    CHECK(seen.at("max_mach_water") == 0.4);
    CHECK(seen.at("max_mach_water_time") == 0.25);
  }

  TEST_CASE(
      "particles that come to sit inside a wall stop the run within sixteen advection steps") {
    Rig<2> rig(all_phases, {"numerics.max_lost_fraction=0.001"});
    rig.plan_it();
    rig.advance(1);
    const long before = rig.world.clock.advection_steps;
    std::optional<Instability> found;
    for (int step = 0; step < 16 && !found; ++step) {
      // Deeper than half a spacing below the floor; its forces may throw it out, so it is put back
      // each time.
      rig.soil().vector(fields::position)[0] = Vec<2>(0.5, -0.17);
      rig.soil().vector(fields::velocity)[0].setZero();
      rig.arrange();
      found = verdict(rig);
    }
    REQUIRE(found);
    CHECK(found->set == "soil");
    CHECK(found->cause == "penetration");
    CHECK(rig.world.clock.advection_steps <= before + 16);
  }

  TEST_CASE("what is clamped inside a wall is not lost") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.05
gravity: 9.81
end_time: 1
materials:
  - {name: water, type: water, sound_speed: 20}
  - {name: rubber, type: elastic, density: 1200, youngs_modulus: 1e6}
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 0.5, 0.3]},
      pressure: hydrostatic}
  - name: shelf
    material: rubber
    shape: {type: box, min: [-0.15, 0, 0.4], max: [0.4, 0.5, 0.5]}
    clamped: [{shape: {type: box, min: [-1, -1, -1], max: [0, 1, 1]}}]
boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.5, 1], open: [top]}]
)");
    rig.plan_it();
    for (int step = 0; step < 20; ++step) CHECK_FALSE(verdict(rig));
    for (const auto& [name, value] : rig.stepper->guard().extremes())
      if (name == "in_walls_interface") CHECK(value == 0);
  }
}
