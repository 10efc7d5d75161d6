// What the planner makes of packed records, and the check that an effect uses no others than it
// names.

#include <doctest/doctest.h>

#include <algorithm>

#include "plan/fake_effects.h"
#include "plan/plan.h"
#include "plan/record_plan.h"
#include "support/rig.h"

using namespace sphgeo;
using test::FakeWorld;

namespace {

std::vector<std::string> order_of(const std::string& scenario) {
  FakeWorld f(scenario);
  Plan<2> plan(f.world, {});
  std::vector<std::string> out;
  for (const auto& e : plan.effects()) out.push_back(e.info.name);
  return out;
}

std::string refusal(const std::string& scenario) {
  try {
    order_of(scenario);
  } catch (const std::logic_error& e) {
    return e.what();
  }
  return "none";
}

// What running a stage says, with or without the check of uses.
std::string complaint_of_run(const std::string& scenario, bool checked) {
  FakeWorld f(scenario);
  Plan<2> plan(f.world, {});
  f.world.records().check_uses(checked);
  try {
    plan.run(Stage::force);
  } catch (const std::logic_error& e) {
    return e.what();
  }
  return "none";
}

void check_says(const std::string& text, const std::vector<std::string>& words) {
  CAPTURE(text);
  for (const auto& w : words) {
    CAPTURE(w);
    CHECK(text.find(w) != std::string::npos);
  }
}

}  // namespace

TEST_SUITE("plan") {
  TEST_CASE("who reads what was there before a stage comes before who writes it") {
    CHECK(order_of("previous") == std::vector<std::string>{"fake_previous_x", "fake_previous_w"});
    check_says(refusal("previous_derived"), {"'fake_derived_x'", "'volume'", "not saved"});
  }

  TEST_CASE("records order effects: write, update, read, and readers before who voids them") {
    CHECK(order_of("records") == std::vector<std::string>{"fake_r_3", "fake_r_2", "fake_r_1",
                                                          "fake_r_5", "fake_r_6", "fake_r_4"});
    FakeWorld f("records");
    Plan<2> plan(f.world, {});
    CHECK(f.world.records().holds("records", 0));
    CHECK_FALSE(f.world.records().holds("records", 1));
  }

  TEST_CASE("a record that nobody writes names effect, record and set") {
    check_says(refusal("no_record"),
               {"'fake_no_record'", "'first'", "density, pressure", "no effect writes"});
  }

  TEST_CASE("two writers of a record in one stage are refused") {
    check_says(refusal("record_twins"),
               {"'fake_r_twin_1'", "'fake_r_twin_2'", "'first'", "'record_twins'", "'force'"});
  }

  TEST_CASE("effects that wait for a field and a record of each other are refused") {
    check_says(refusal("record_cycle"), {"wait for each other", "fake_r_cycle_1"});
  }

  TEST_CASE("a record over which another one was packed is void") {
    check_says(refusal("used_up"), {"'fake_used_3'", "'first'", "'fake_used_2' has used up"});
    check_says(refusal("covered"),
               {"'fake_covered_3'", "'first'", "'fake_covered_2' has packed record 'second'"});
  }

  TEST_CASE("a supporting effect is called for by a record that it writes") {
    CHECK(order_of("record_chain") == std::vector<std::string>{"fake_r_support", "fake_r_user"});
  }

  TEST_CASE("an effect that asks for a record which its needs do not name fails") {
    check_says(complaint_of_run("undeclared_read", true),
               {"'fake_undeclared_read'", "reads", "'first'", "'undeclared_read'"});
    check_says(complaint_of_run("undeclared_write", true),
               {"'fake_reads_only'", "packs", "'second'", "'undeclared_write'"});
    CHECK(complaint_of_run("records", true) == "none");
    CHECK(complaint_of_run("undeclared_read", false) == "none");
  }

  TEST_CASE("rows tell who writes, reads and voids a record") {
    FakeWorld f("records");
    const std::vector<RecordRow> rows = record_rows(Plan<2>(f.world, {}).records());
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].written_by == std::vector<std::string>{"fake_r_3", "fake_r_2"});
    CHECK(rows[0].read_by == std::vector<std::string>{"fake_r_1", "fake_r_5", "fake_r_6"});
    CHECK(rows[0].shares_with == std::vector<std::string>{"second"});
    CHECK(rows[1].written_by == std::vector<std::string>{"fake_r_4"});
  }

  TEST_CASE("records of a scene with all phases are used as they are named") {
    test::Rig<2> rig(
        "dimension: 2\nresolution: 0.05\nend_time: 1\nmaterials:\n"
        "  - {name: water, type: water}\n"
        "  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e6, "
        "friction: 0.5, grain_size: 0.001}\n"
        "  - {name: rubber, type: elastic, density: 1000, youngs_modulus: 1e6, "
        "viscosity_factor: 0.1}\n"
        "  - {name: rock, type: rigid, density: 2500}\nbodies:\n"
        "  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 0, "
        "0.3]}}\n"
        "  - {name: bed, material: sand, shape: {type: box, min: [0, 0, 0], max: [0.4, 0, 0.3]}}\n"
        "  - {name: plate, material: rubber, spacing: 0.025, shape: {type: box, min: [0.5, 0, 0], "
        "max: [0.6, 0, 0.4]}}\n"
        "  - {name: boulder, material: rock, shape: {type: box, min: [0.1, 0, 0.4], max: [0.3, 0, "
        "0.6]}}\n"
        "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.8, 0, 0.8]}]\n"
        "relaxation: {steps: 2}\nprobes:\n"
        "  - {name: push, type: force, boundary: tank}\n"
        "  - {name: pores, type: mean, set: soil, field: pore_pressure}\n",
        {});
    rig.world.records().check_uses(true);
    rig.plan_it({{"soil", "saturation", "test", true}});
    CHECK_NOTHROW(rig.plan->run(Stage::observe));
    CHECK_NOTHROW(rig.advance(2));
    CHECK_NOTHROW(rig.plan->run(Stage::observe));
  }
}
