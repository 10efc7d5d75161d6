// Which effects, fields and lists a scene gets: pinned, so that a change of the physics is a change
// of these files too. To write them anew: SPHGEO_UPDATE_PLANS=1 sphgeo_tests -ts=explain

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "plan/fake_effects.h"
#include "run/wishes.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;
using Json = nlohmann::ordered_json;

namespace {

const std::string head = "resolution: 0.05\nend_time: 1\nmaterials: [{name: water, type: water}]\n";
const std::string pool =
    "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 0.2, "
    "0.3]}}]\n";
const std::string tank =
    "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.4, 0.2, 0.4], open: [top]}]\n";
const std::string gates =
    "boundaries:\n"
    "  - {name: tank, type: tank, min: [0, 0, 0], max: [0.4, 0.2, 0.4], open: [top, right]}\n"
    "  - {name: gate, type: wall, shape: {type: box, min: [0.4, 0, 0], max: [0.6, 0.2, 0.5]}, "
    "motion: {displacement: [0, 0, t]}}\n";
const std::string probes =
    "probes:\n"
    "  - {name: push, type: force, boundary: tank}\n"
    "  - {name: level, type: water_level, at: [0.2, 0.1, 0]}\n";

// Of elastic, rigid or both kinds of solids, in what is around them.
std::string solids(const std::string& rest) {
  return "resolution: 0.05\nend_time: 1\nmaterials:\n  - {name: water, type: water}\n"
         "  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e6, "
         "friction: 0.5, grain_size: 0.001}\n"
         "  - {name: rubber, type: elastic, density: 1000, youngs_modulus: 1e6}\n  - {name: rock, "
         "type: rigid, density: 2500}\nbodies:\n" +
         rest;
}
const std::string plate =
    "  - {name: plate, material: rubber, spacing: 0.025, shape: {type: box, min: [0.6, 0, 0], max: "
    "[0.7, 0.2, 0.4]}}\n";
const std::string boulder =
    "  - {name: boulder, material: rock, shape: {type: box, min: [1, 0, 0], max: [1.2, 0.2, "
    "0.2]}}\n";
const std::string water =
    "  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 0.2, 0.3]}}\n";
const std::string sand =
    "  - {name: bed, material: sand, shape: {type: box, min: [0, 0, 0], max: [0.4, 0.2, 0.3]}}\n";

template <int Dim>
Json plan_of(const std::string& deck, const std::vector<std::string>& overrides = {}) {
  Rig<Dim> rig("dimension: " + std::to_string(Dim) + "\n" + deck, overrides);
  std::vector<std::string> sets;
  for (const auto& s : rig.world.sets()) sets.push_back(s->name());
  rig.plan_it(wishes_of(rig.model, sets));
  Json j;
  for (const auto& e : rig.plan->effects())
    j["plan"].push_back({{"stage", stage_name(e.info.stage)}, {"name", e.info.name}});
  j["unused"] = Json::array();
  for (const auto& u : rig.plan->unused())
    if (u.name.rfind(test::fake_prefix, 0) != 0) j["unused"].push_back(u.name);
  for (const auto& [key, list] : rig.world.lists())
    j["lists"].push_back(key.first + " -> " + key.second);
  for (const auto& set : rig.world.sets()) {
    Json names = Json::array();
    for (const auto& [name, field] : set->fields()) names.push_back(name);
    j["fields"][set->name()] = names;
  }
  for (const RecordRow& r : record_rows(rig.plan->records()))
    j["records"].push_back({{"set", r.set},
                            {"name", r.record->name},
                            {"written_by", r.written_by},
                            {"read_by", r.read_by},
                            {"used_up_by", r.used_up_by}});
  return j;
}

void compare(const std::string& name, const Json& plan) {
  const std::string path = std::string(SPHGEO_SOURCE_DIR) + "/tests/explain/" + name + ".json";
  if (std::getenv("SPHGEO_UPDATE_PLANS")) {
    std::ofstream(path) << plan.dump(2) << "\n";
    return;
  }
  std::ifstream file(path);
  std::ostringstream pinned;
  pinned << file.rdbuf();
  CAPTURE(path);
  CHECK(pinned.str() == plan.dump(2) + "\n");
}

}  // namespace

TEST_SUITE("explain") {
  TEST_CASE("plan of a free body of water") { compare("free_water", plan_of<2>(head + pool)); }
  TEST_CASE("plan of a tank with probes") {
    compare("tank_with_probes", plan_of<2>(head + pool + tank + probes));
  }
  TEST_CASE("plan of one elastic solid alone") { compare("solid", plan_of<3>(solids(plate))); }
  TEST_CASE("plan of an elastic and a rigid solid") {
    compare("solids", plan_of<3>(solids(plate + boulder)));
  }
  TEST_CASE("plan of solids in water") {
    compare("water_solids", plan_of<2>(solids(water + plate + boulder)));
  }
  TEST_CASE("plan of soil alone") { compare("soil", plan_of<3>(solids(sand))); }
  TEST_CASE("plan of soil in a tank with probes") {
    compare("soil_with_probes",
            plan_of<2>(solids(sand) + tank +
                       "probes:\n  - {name: inside, type: stress, at: [0.2, 0.1, 0.1]}\n"
                       "  - {name: push, type: force, boundary: tank}\n  - {name: moments, type: "
                       "moments, set: soil}\n"));
  }
  TEST_CASE("plan of soil and its pore water") {
    compare("water_soil", plan_of<2>(solids(water + sand) + "relaxation: {steps: 2}\n"));
  }
  TEST_CASE("plan of soil and water with probes and without drag") {
    compare("water_soil_with_probes",
            plan_of<2>(solids(water + sand) + tank +
                           "relaxation: {steps: 2}\nprobes:\n"
                           "  - {name: inside, type: stress, at: [0.2, 0.1, 0.1]}\n"
                           "  - {name: pores, type: mean, set: water, field: water_fraction}\n",
                       {"materials.sand.drag=none"}));
  }
  TEST_CASE(
      "an effect that the deck switches off is in no plan, and the plan says what that means") {
    Rig<2> rig("dimension: 2\n" + solids(water + sand) +
               "relaxation: {steps: 2}\nwithout: [drag]\n");
    rig.plan_it({});
    for (const auto& e : rig.plan->effects()) {
      CHECK(e.info.name != "drag");
    }
    int told = 0;
    for (const auto& u : rig.plan->unused())
      if (u.because.find("switched off by the deck: ") == 0) ++told;
    CHECK(told == 1);
  }
  TEST_CASE("plan of a boulder on soil") {
    compare("soil_boulder", plan_of<2>(solids(sand + boulder)));
  }
  TEST_CASE("plan of everything") {
    compare("all_phases",
            plan_of<2>(solids(water + sand + plate + boulder) + tank + "relaxation: {steps: 2}\n"));
  }
  TEST_CASE("plan of a tank with a gate in 3D") {
    compare("gate", plan_of<3>(head + pool + gates));
  }
  TEST_CASE("plan without re-initialization and transport velocity") {
    compare("plain_numerics",
            plan_of<2>(head + pool + tank +
                       "numerics: {density_reinitialization: none, transport_velocity: false}\n"));
  }
}
