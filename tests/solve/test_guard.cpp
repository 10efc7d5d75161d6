#include <doctest/doctest.h>

#include <fmt/format.h>

#include <limits>

#include "core/error.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string pool(int dimension) {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
end_time: 1
materials: [{{name: water, type: water, sound_speed: 20}}]
bodies: [{{name: pool, material: water, shape: {{type: box, min: [0, 0, 0], max: [1, 0.5, 0.5]}},
    pressure: hydrostatic}}]
boundaries:
  - {{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.5, 1], open: [top]}}
  - {{name: paddle, type: wall, shape: {{type: box, min: [0.7, 0, 0.8], max: [0.8, 0.5, 1]}},
      motion: {{displacement: [0.01*sin(9*t), 0, 0]}}}}
)",
                     dimension);
}

/// What the guard says when the run goes on for this many advection steps; nullopt when it says
/// nothing.
template <int Dim>
std::optional<Instability> verdict(Rig<Dim>& rig, long steps, std::string* sentence = nullptr) {
  try {
    rig.advance(steps);
  } catch (const UnstableError& e) {
    if (sentence) *sentence = e.what();
    return e.instability;
  }
  return std::nullopt;
}

/// Plants a value that is no number in one field of one set; false when the field holds none.
template <int Dim>
bool plant(ParticleSet<Dim>& set, const FieldSpec& spec, Index i, double odd) {
  if (spec.type == FieldType::scalar) set.scalar(spec)[i] = odd;
  else if (spec.type == FieldType::vector) set.vector(spec)[i][Dim - 1] = odd;
  else return false;
  return true;
}

template <int Dim>
void plant_everywhere() {
  Rig<Dim> model(pool(Dim));
  model.plan_it();
  int planted = 0;
  for (const auto& set : model.world.sets())
    for (const auto& [name, field] : set->fields())
      for (const double odd :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        if (field->spec().lifetime == Lifetime::derived)
          continue;  // computed anew before anyone reads it
        Rig<Dim> rig(pool(Dim));
        rig.plan_it();
        rig.advance(2);
        ParticleSet<Dim>& victim = rig.world.set(set->name());
        if (!plant(victim, field->spec(), victim.size() / 2, odd)) continue;
        ++planted;
        CAPTURE(set->name());
        CAPTURE(name);
        CAPTURE(odd);
        std::string sentence;
        const long before = rig.world.clock.advection_steps;
        const auto found = verdict(rig, 1, &sentence);
        // Motions write place, velocity, acceleration and normal of moving walls anew from what was
        // at the start: a bad value is gone before it is used.
        if (set->phase() == "wall" && !found) {
          CHECK_MESSAGE((name == "position" || name == "velocity" || name == "acceleration" ||
                         name == "normal"),
                        sentence);
          CHECK(rig.world.set("walls").vector(field->spec())[victim.size() / 2].allFinite());
          continue;
        }
        REQUIRE(found);
        CHECK(found->cause == "not_finite");
        CHECK(rig.world.clock.advection_steps <= before + 1);
        CHECK_THROWS_AS(rig.stepper->guard().check_all(), UnstableError);
      }
  CHECK(planted >= 20);
}

}  // namespace

TEST_SUITE("solve") {
  TEST_CASE(
      "a value that is no number is caught in the same advection step, in every field of every "
      "set") {
    plant_everywhere<2>();
    plant_everywhere<3>();
  }

  TEST_CASE("the guard says nothing of a sound run") {
    Rig<2> rig(pool(2));
    rig.plan_it();
    CHECK_FALSE(verdict(rig, 40));
    rig.stepper->guard().check_all();
    bool seen = false;
    for (const auto& [name, value] : rig.stepper->guard().extremes())
      if (name == "max_density_water") {
        seen = true;
        CHECK(value > 1000);
        CHECK(value < 1100);
      }
    CHECK(seen);
  }

  TEST_CASE(
      "water faster than sound stops the run: who, where, when, whose result, which line of the "
      "deck") {
    Rig<2> rig(pool(2), {"bodies[0].velocity=[25*x, 0, 0]"});
    rig.plan_it();
    std::string sentence;
    const auto found = verdict(rig, 1, &sentence);
    REQUIRE(found);
    CHECK(found->cause == "speed");
    CHECK(found->set == "water");
    CHECK(found->effect == "water_kick");
    REQUIRE(found->place);
    CHECK(found->place->x() == doctest::Approx(0.95));
    CHECK(found->time == 0.0);
    CHECK(found->particle);
    for (const char* part :
         {"23.75 m/s", "body 'pool' (deck:6:", "sound_speed", "by effect water_kick"}) {
      CAPTURE(part);
      CHECK(sentence.find(part) != std::string::npos);
    }
  }

  TEST_CASE("a density out of bounds stops the run") {
    Rig<2> rig(pool(2), {"numerics.density_bound=0.1"});
    rig.plan_it();
    rig.advance(1);
    CHECK_FALSE(verdict(rig, 1));
    for (const double odd : {1101.0, 899.0}) {
      rig.water().scalar(fields::density)[3] = odd;
      try {
        rig.stepper->guard().after_advection();
        FAIL("not stopped");
      } catch (const UnstableError& e) {
        CHECK(e.instability.cause == "density");
        CHECK(e.instability.set == "water");
        CHECK(e.instability.particle == rig.water().ids()[3]);
      }
    }
  }

  TEST_CASE("a step that collapses stops the run") {
    Rig<2> rig(pool(2));
    rig.plan_it();
    Guard<2>& guard = rig.stepper->guard();
    const StepLimits limits = rig.plan->limits();
    guard.before_step(limits, 1e-3);
    guard.before_step(limits, 2e-7);
    CHECK_THROWS_WITH_AS(guard.before_step(limits, 5e-8), doctest::Contains("collapsed"),
                         UnstableError);
    CHECK_THROWS_AS(guard.before_step(limits, 0.0), UnstableError);
  }

  TEST_CASE("lost particles are allowed up to the budget of their set") {
    const auto lose = [](const std::string& budget) {
      Rig<2> rig(pool(2), {"numerics.max_lost_fraction=" + budget});
      rig.plan_it();
      for (Index i = 0; i < 2; ++i) rig.water().vector(fields::position)[i] = Vec<2>(0, 100);
      return verdict(rig, 2);
    };
    CHECK_FALSE(lose("0.04"));  // 2 of 50
    const auto found = lose("0.03");
    REQUIRE(found);
    CHECK(found->cause == "lost");
  }

  TEST_CASE("particles that sit inside a wall count as lost") {
    Rig<2> rig(pool(2), {"numerics.max_lost_fraction=0.03"});
    rig.water().vector(fields::position)[0] = Vec<2>(0.5, -0.17);
    rig.plan_it();
    rig.stepper->guard().after_advection();
    const auto count = rig.stepper->guard().extremes();
    CHECK(count.back() == std::pair<std::string, double>{"in_walls_water", 1.0});
    Rig<2> strict(pool(2), {"numerics.max_lost_fraction=0.01"});
    strict.water().vector(fields::position)[0] = Vec<2>(0.5, -0.17);
    strict.plan_it();
    CHECK_THROWS_WITH_AS(strict.stepper->guard().after_advection(),
                         doctest::Contains("1 sit inside a wall"), UnstableError);
  }
}
