#include <doctest/doctest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "sample_types.h"

using namespace sphgeo;
using namespace sphgeo::sample;

namespace {

const Block& block_of(const Model& m) { return dynamic_cast<const Block&>(*m.bodies[0].shape); }

/// Calls `visit` on every object inside a JSON value.
void walk(const Json& json, const std::function<void(const Json&)>& visit) {
  if (json.is_object()) visit(json);
  if (json.is_structured()) {
    for (const Json& part : json) walk(part, visit);
  }
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("a deck becomes plain values in SI") {
    const Model m = read_deck_text(good_deck());
    CHECK(m.title == "Dam break");
    CHECK(m.dimension == 2);
    CHECK(m.resolution == 0.01);
    CHECK(m.gravity == Vec3(0, 0, -9.81));
    CHECK(*m.variables.find("W") == 1.6);
    CHECK(m.material("water") == m.materials[0].get());
    CHECK(m.material("oil") == nullptr);
    CHECK(m.materials[0]->type == "sample_liquid");
    CHECK(dynamic_cast<const Liquid&>(*m.materials[0]).density == 1000.0);
    CHECK(m.bodies[0].pressure.word == "hydrostatic");
    CHECK(*m.bodies[0].level == 0.5);
    CHECK(m.bodies[0].velocity[0](Vec3(0, 0, 2), 0) == 0.2);
    CHECK(block_of(m).max == Vec3(0.4, 0, 0.2));
    CHECK(block_of(m).flat);
    CHECK(*m.probes[0]->every == 1e-3);
    CHECK(dynamic_cast<const Gauge&>(*m.probes[0]).at == Vec3(1.6, 0, 0.003));
    CHECK(m.frame_interval() == 0.1);
    CHECK(m.run_interval() == 0.01);
    CHECK(m.expect[0].tolerance == 0.01);
    CHECK(m.warnings.items().empty());
  }

  TEST_CASE("points have three components in 3D; axes of rotation keep y in 2D") {
    std::string text = with("dimension: 2", "dimension: 3");
    for (const auto& [from, to] :
         {std::pair{"[0.1*z, 0]", "[0.1*z, 7, 0]"}, std::pair{"[W, 0.003]", "[W, 3, 0.003]"}}) {
      text.replace(text.find(from), std::string(from).size(), to);
    }
    const Model m = read_deck_text(text);
    CHECK(block_of(m).max == Vec3(0.4, 0.1, 0.2));
    CHECK_FALSE(block_of(m).flat);
    CHECK(m.bodies[0].velocity[1](Vec3::Zero(), 0) == 7.0);
    const Model flat = read_deck_text(with("[L, 0.1, H]", "[L, 0.1, H], axis: [0, 3, 0]"));
    CHECK(block_of(flat).axis == Vec3(0, 3, 0));
    CHECK(block_of(flat).max.y() == 0.0);
  }

  TEST_CASE("gravity is a magnitude or a vector") {
    CHECK(read_deck_text(with("gravity: 9.81", "gravity: [1, 2, -3]")).gravity == Vec3(1, 0, -3));
    CHECK(read_deck_text(with("gravity: 9.81", "gravity: 0")).gravity == Vec3::Zero());
    CHECK(read_deck_text(with("gravity: 9.81\n", "")).gravity == Vec3(0, 0, -9.81));
  }

  TEST_CASE("auto is the empty optional, notes are ignored everywhere") {
    CHECK_FALSE(
        read_deck_text(with("level: 2*H + 0.1", "level: auto")).bodies[0].level.has_value());
    CHECK(findings(with("limiter: 3", "limiter: 3\n  x-why: [because]")).empty());
    CHECK(findings(with("{type: sample_block", "{x-a: 1, type: sample_block")).empty());
    CHECK(findings("x-note: 1\n" + good_deck()).empty());
  }

  TEST_CASE("places lead back to the deck, or to the nearest section of a default") {
    const Model m = read_deck_text(good_deck(), {}, "a.yaml");
    CHECK(m.place_of("bodies[0].shape.max").line == 12);
    CHECK(m.place_of("bodies[0].filling").line == 10);
    CHECK(m.place_of("numerics.outside").line == 22);
    CHECK(m.place_of("nonsense.a[3]").line == 1);
  }

  TEST_CASE("the resolved deck holds all defaults and reads back identically") {
    std::string text =
        with("{type: sample_block, min: [0, 0, 0], max: [L, 0.1, H]}",
             "{type: sample_group, of: [{type: sample_block, min: [0, 0, 0], max: [L, "
             "0.1, H], rounding: 1/30, roughness: 'x > 0.1 ? 0.1 : z*L'}]}");
    text.replace(text.find("pressure: hydrostatic"), 21, "pressure: 100*(H - z)");
    text.replace(text.find("    level: 2*H + 0.1\n"), 21, "");
    text.replace(text.find("title: Dam break"), 16, "title: \"a: 'b' #\\\"c\"");
    const Model first = read_deck_text(text);
    const std::string resolved = resolved_yaml(first);
    CAPTURE(resolved);
    for (const char* part :
         {"limiter: 3", "cfl_acoustic: 0.4", "sound_speed: auto", "filling: \"auto\"",
          "friction_angle: 0.5", "rounding: 0.03333333333333333"}) {
      CHECK(resolved.find(part) != std::string::npos);
    }
    const Model second = read_deck_text(resolved);
    CHECK(resolved_yaml(second) == resolved);
    CHECK(second.title == first.title);
    CHECK(second.bodies[0].pressure.formula(Vec3(0, 0, 0.1), 0) ==
          first.bodies[0].pressure.formula(Vec3(0, 0, 0.1), 0));
    CHECK(deck_hash(second) == deck_hash(first));
  }

  TEST_CASE("the hash tells what decides the result from what may change on resume") {
    const std::string hash = deck_hash(read_deck_text(good_deck()));
    CHECK(hash.size() == 16);
    // No structured bindings here: clang 14 cannot CAPTURE them.
    for (const auto& change :
         {std::pair{"end_time: 2 s", "end_time: 3 s"}, std::pair{"Dam break", "dam"},
          std::pair{"every: 0.1", "every: 0.2"}, std::pair{"20 cm", "0.2"}, std::pair{"1 %", "2 %"},
          std::pair{"limiter: 3", "limiter: 3.0"}}) {
      CAPTURE(change.second);
      CHECK(deck_hash(read_deck_text(with(change.first, change.second))) == hash);
    }
    for (const auto& change : {std::pair{"0.01 m", "0.02 m"}, std::pair{"limiter: 3", "limiter: 4"},
                               std::pair{"1 g/cm3", "1.1 g/cm3"}, std::pair{"0.1*z", "0.2*z"}}) {
      CAPTURE(change.second);
      CHECK(deck_hash(read_deck_text(with(change.first, change.second))) != hash);
    }
  }

  TEST_CASE("the JSON Schema is sound: references resolve, required keys exist, all is described") {
    const Json schema = json_schema();
    CHECK(schema["$schema"] == "http://json-schema.org/draft-07/schema#");
    int sections = 0;
    walk(schema, [&](const Json& part) {
      if (part.contains("$ref")) {
        const std::string name = part["$ref"].get<std::string>();
        REQUIRE(name.rfind("#/definitions/", 0) == 0);
        CHECK(schema["definitions"].contains(name.substr(14)));
        CHECK(part.size() == 1);
      }
      if (!part.contains("patternProperties")) return;
      ++sections;
      CHECK(part["additionalProperties"] == false);
      if (part.contains("required")) {
        for (const Json& key : part["required"])
          CHECK(part["properties"].contains(key.get<std::string>()));
      }
      for (const auto& property : part["properties"].items()) {
        CAPTURE(property.key());
        CHECK(property.value().contains("description"));
      }
    });
    CHECK(sections > 10);
    for (const char* kind : {"shape", "material", "boundary", "probe"}) {
      std::set<std::string> types;
      for (const Json& type : schema["definitions"][kind]["oneOf"]) {
        CHECK(types.insert(type["properties"]["type"]["const"].get<std::string>()).second);
      }
      CHECK_FALSE(types.empty());
    }
    CHECK(schema["properties"]["resolution"]["exclusiveMinimum"] == 0);
    CHECK(schema["properties"]["resolution"]["x-unit"] == "m");
    CHECK(schema["properties"]["numerics"]["properties"]["outside"]["enum"].size() == 2);
    CHECK(schema["properties"]["numerics"]["properties"]["limiter"]["default"] == 3);
    CHECK(json_schema().dump() == schema.dump());
  }

  TEST_CASE("a registry knows its types by name and refuses a second of one name") {
    const RegistryCore& shapes = Registry<Shape>::get();
    REQUIRE(shapes.find("sample_block") != nullptr);
    CHECK(shapes.find("sample_block")->schema().sentence() == "A block along the axes.");
    CHECK(shapes.find("nothing") == nullptr);
    const std::vector<std::string> names = shapes.names();
    CHECK(std::is_sorted(names.begin(), names.end()));
    CHECK_THROWS_AS((Register<Shape, Block>{"sample_block"}), std::logic_error);
  }

  TEST_CASE("a second liquid is refused where something is made of it") {
    const auto found = [](const std::string& body_of) {
      Diagnostics out;
      try {
        out = read_deck_text(
                  "dimension: 2\nresolution: 0.1\nend_time: 1\nmaterials:\n"
                  "  - {name: water, type: water}\n"
                  "  - {name: oil, type: water, density: 800}\nbodies:\n"
                  "  - {name: a, material: water, shape: {type: box, min: [0, 0, 0], "
                  "max: [1, 1, 1]}}\n"
                  "  - {name: b, material: " +
                  body_of + ", shape: {type: box, min: [1, 0, 0], max: [2, 1, 1]}}\n")
                  .warnings;
      } catch (const DeckError& e) {
        return e.diagnostics.items().at(0).id + " " + e.diagnostics.items().at(0).path;
      }
      return std::string();
    };
    CHECK(found("oil") == "E025 materials[1]");
    CHECK(found("water").empty());
  }
}
