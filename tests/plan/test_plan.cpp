#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "plan/fake_effects.h"
#include "sph/parameters.h"
#include "support/rig.h"

using namespace sphgeo;
using test::FakeWorld;
using test::Rig;

namespace {

template <int K>
const RegisterEffect<test::FakeCase<K>::template Run> registered;

// Names all instances, so that they exist.
template <int... K>
std::size_t register_fakes(std::integer_sequence<int, K...>) {
  return (0 + ... + (&registered<K> != nullptr ? 1 : 0));
}
const std::size_t fake_count = register_fakes(std::make_integer_sequence<int, test::fakes>());

std::vector<std::string> names(const auto& plan) {
  std::vector<std::string> out;
  for (const auto& e : plan.effects()) out.push_back(e.info.name);
  return out;
}

bool runs(const auto& plan, const std::string& name) {
  const auto all = names(plan);
  return std::find(all.begin(), all.end(), name) != all.end();
}

std::string reason_not_used(const auto& plan, const std::string& name) {
  for (const auto& u : plan.unused())
    if (u.name == name) return u.because;
  return {};
}

// What the planner says to a scenario that cannot work.
std::string complaint(const std::string& scenario, const std::vector<Wish>& wishes = {}) {
  FakeWorld f(scenario);
  try {
    Plan<2> plan(f.world, wishes);
  } catch (const std::logic_error& e) {
    return e.what();
  }
  return "none";
}

bool says(const std::string& text, const std::vector<std::string>& words) {
  CAPTURE(text);
  for (const auto& w : words) {
    CAPTURE(w);
    CHECK(text.find(w) != std::string::npos);
  }
  return text != "none";
}

const char* const pool = R"(
dimension: 2
resolution: 0.05
end_time: 1
materials: [{name: water, type: water}]
bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 0.1, 0.3]}}]
)";
const char* const pool_walls =
    "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.4, 0.1, 0.4]}]\n";

}  // namespace

TEST_SUITE("plan") {
  TEST_CASE("stages in order; in a stage write, add, update, read") {
    REQUIRE(fake_count == test::fakes);
    FakeWorld f("order");
    Plan<2> plan(f.world, {});
    CHECK(names(plan) == std::vector<std::string>{"fake_e_early", "fake_d_write", "fake_c_add",
                                                  "fake_b_update", "fake_a_read"});
    // Fields and lists are the union of what the effects need.
    CHECK(f.world.set("order").has(fields::pressure));
    CHECK(f.world.set("order").has(fields::density));
    CHECK_FALSE(f.world.set("order").has(fields::volume));
    CHECK(f.world.lists().size() == 1);
    CHECK(f.world.lists().contains({"order", "order"}));
  }

  TEST_CASE("a stage runs its own effects only, and counts the calls") {
    FakeWorld f("order");
    Plan<2> plan(f.world, {});
    plan.run(Stage::force);
    CHECK(f.world.clock.advection_steps == 4);
    plan.run(Stage::predict);
    plan.run(Stage::kick);
    CHECK(f.world.clock.advection_steps == 5);
    for (const auto& e : plan.effects()) CHECK(e.calls == 1);
  }

  TEST_CASE("the step limits are the smallest of all effects") {
    FakeWorld f("order");
    const StepLimits limits = Plan<2>(f.world, {}).limits();
    CHECK(limits.acoustic == 1.0);
    CHECK(limits.advection == 96.0);
  }

  TEST_CASE("a derived field without a producer names effect, field and set") {
    CHECK(says(complaint("missing"),
               {"'fake_missing'", "'volume'", "'missing'", "no effect computes"}));
  }

  TEST_CASE("two producers in one stage are refused, in two stages they are fine") {
    CHECK(says(complaint("twins"),
               {"'fake_twin_1'", "'fake_twin_2'", "'volume'", "'twins'", "'force'"}));
    CHECK(complaint("two_stages") == "none");
  }

  TEST_CASE("effects that wait for each other are refused") {
    CHECK(says(complaint("cycle"), {"wait for each other", "fake_cycle_1", "'force'"}));
  }

  TEST_CASE("who adds to a sum needs someone who starts it in the same stage") {
    CHECK(says(complaint("lonely_add"), {"'fake_lonely_add'", "'pressure'", "'force'"}));
  }

  TEST_CASE(
      "a wish for a field that nobody computes names who wishes; an optional one is left out") {
    CHECK(says(complaint("order", {{"order", "volume", "probe gauge", false}}),
               {"probe gauge", "'volume'", "'order'"}));
    CHECK(complaint("order", {{"order", "volume", "frames", true}}) == "none");
  }

  TEST_CASE("supporting effects run only when something asks for what they make, along a chain") {
    {
      FakeWorld f("chain");
      Plan<2> plan(f.world, {});
      CHECK(names(plan) == std::vector<std::string>{"fake_always"});
      CHECK(reason_not_used(plan, "fake_makes_x").find("no effect, probe or frame") !=
            std::string::npos);
      CHECK_FALSE(f.world.set("chain").has(fields::volume));
    }
    {
      FakeWorld f("chain");
      Plan<2> plan(f.world, {{"chain", "volume", "probe amount", false}});
      CHECK(names(plan) == std::vector<std::string>{"fake_always", "fake_makes_x"});
      CHECK(plan.effects()[1].because == "asked for by probe amount");
    }
    FakeWorld f("chain");
    Plan<2> plan(f.world, {{"chain", "fluid_force", "probe force", false}});
    CHECK(names(plan) == std::vector<std::string>{"fake_always", "fake_makes_x", "fake_makes_y"});
    CHECK(plan.effects()[1].because == "asked for by effect fake_makes_y");
    CHECK(plan.effects()[2].because == "asked for by probe force");
  }

  TEST_CASE("what is made for observers does not serve the steps") {
    CHECK(says(complaint("late"), {"'fake_early_reader'", "'volume'", "'late'"}));
  }

  TEST_CASE("a scene without walls has no effect, field or list of walls") {
    Rig<2> free(pool);
    free.plan_it();
    for (const auto& e : free.plan->effects()) CHECK(e.info.name.find("wall") == std::string::npos);
    for (const char* name : {"wall_state", "wall_motion", "water_reaction", "water_wall_force",
                             "water_wall_continuity"})
      CHECK_FALSE(reason_not_used(*free.plan, name).empty());
    CHECK(free.world.find("walls") == nullptr);
    CHECK(free.world.lists().size() == 1);
    Rig<2> walled(std::string(pool) + pool_walls);
    walled.plan_it();
    CHECK(runs(*walled.plan, "water_wall_force"));
    CHECK(runs(*walled.plan, "water_wall_continuity"));
    CHECK_FALSE(runs(*walled.plan, "wall_motion"));
    CHECK(walled.world.lists().contains({"water", "walls"}));
    CHECK_FALSE(walled.world.lists().contains({"walls", "water"}));
  }

  TEST_CASE("a force probe pulls in the reaction on the walls, its list, and its mean") {
    const std::string deck = std::string(pool) + pool_walls;
    Rig<2> without(deck);
    without.plan_it();
    for (const char* name : {"water_reaction", "mean_force"})
      CHECK_FALSE(runs(*without.plan, name));
    CHECK_FALSE(without.walls().has(fields::water_force));
    CHECK_FALSE(without.walls().has(fields::mean_water_force));
    Rig<2> with(deck + "probes: [{name: push, type: force, boundary: tank}]\n");
    with.plan_it();
    CHECK(runs(*with.plan, "water_reaction"));
    CHECK(runs(*with.plan, "mean_force"));
    CHECK(with.world.lists().contains({"walls", "water"}));
    const auto all = names(*with.plan);
    CHECK(std::find(all.begin(), all.end(), "water_reaction") <
          std::find(all.begin(), all.end(), "mean_force"));
  }

  TEST_CASE("a moving wall binds its motion") {
    Rig<2> rig(std::string(pool) +
               "boundaries: [{name: piston, type: wall, shape: {type: box, min: [-0.5, 0, 0], max: "
               "[0, 0.1, 0.4]}, "
               "motion: {displacement: [0.1*t, 0, 0]}}]\n");
    rig.plan_it();
    CHECK(runs(*rig.plan, "wall_motion"));
  }

  TEST_CASE("every effect says what it is, and a bound one why") {
    for (const auto& entry : EffectRegistry::all()) {
      CHECK_FALSE(entry.info.name.empty());
      CHECK_FALSE(entry.info.sentence.empty());
    }
    CHECK(std::is_sorted(EffectRegistry::all().begin(), EffectRegistry::all().end(),
                         [](const auto& a, const auto& b) { return a.info.name < b.info.name; }));
    Rig<2> rig(pool);
    rig.plan_it();
    for (const auto& e : rig.plan->effects()) {
      CHECK_FALSE(e.because.empty());
      CHECK_FALSE(e.effect->acts_on().empty());
    }
    for (const auto& u : rig.plan->unused()) CHECK_FALSE(u.because.empty());
  }
}
