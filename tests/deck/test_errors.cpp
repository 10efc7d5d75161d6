#include <doctest/doctest.h>

#include <fmt/format.h>

#include "core/text.h"
#include "sample_types.h"

using namespace sphgeo;
using namespace sphgeo::sample;

namespace {

/// "E014@3 path" of the single finding in a deck with one text replaced.
std::string after(const std::string& from, const std::string& to) {
  const std::vector<Diagnostic> found = findings(with(from, to));
  if (found.size() != 1) return report(with(from, to)) + fmt::format("({} findings)", found.size());
  return fmt::format("{}@{} {}", found[0].id, found[0].place.line, found[0].path);
}

std::string help_after(const std::string& from, const std::string& to) {
  const std::vector<Diagnostic> found = findings(with(from, to));
  return found.size() == 1 ? found[0].help : fmt::format("{} findings", found.size());
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("E010: a value of the wrong kind") {
    CHECK(after("resolution: 0.01 m", "resolution: [1]") == "E010@3 resolution");
    CHECK(after("resolution: 0.01 m", "resolution: fine") == "E010@3 resolution");
    CHECK(after("resolution: 0.01 m", "resolution: true") == "E010@3 resolution");
    CHECK(after("resolution: 0.01 m", "resolution:") == "E010@3 resolution");
    CHECK(after("dimension: 2", "dimension: 2.5") == "E010@2 dimension");
    CHECK(after("title: Dam break", "title: 12") == "E010@1 title");
    CHECK(after("title: Dam break", "title: off") == "E010@1 title");
    CHECK(after("title: Dam break", "title: {a: 1}") == "E010@1 title");
    CHECK(after("limiter: 3", "transport_velocity: on") == "E010@23 numerics.transport_velocity");
    CHECK(after("limiter: 3", "transport_velocity: 'true'") ==
          "E010@23 numerics.transport_velocity");
    CHECK(after("numerics:\n  limiter: 3", "numerics: 3") == "E010@22 numerics");
    CHECK(after("fields: [velocity]", "fields: velocity") == "E010@21 output.frames.fields");
    CHECK(after("fields: [velocity]", "fields: [1]") == "E010@21 output.frames.fields[0]");
    CHECK(after("min: [0, 0, 0]", "min: 0") == "E010@12 bodies[0].shape.min");
    CHECK(after("shape: {type: sample_block, min", "shape: 5 # {min") == "E010@12 bodies[0].shape");
    CHECK(after("type: sample_block", "type: [sample_block]") == "E010@12 bodies[0].shape.type");
    CHECK(after("velocity: [0.1*z, 0]", "velocity: 1") == "E010@13 bodies[0].velocity");
    CHECK(after("{L: 0.4, H: 20 cm, W: 4*L}", "[0.4]") == "E010@6 variables");
    CHECK(after("H: 20 cm", "H: [1]") == "E010@6 variables.H");
    CHECK(findings("- 1\n")[0].id == "E010");
    CHECK(findings("")[0].id == "E010");
    CHECK(findings("")[0].message == "the deck is empty");
  }

  TEST_CASE("E011: a missing key, named where its mapping starts") {
    CHECK(after("end_time: 2 s\n", "") == "E011@1 ");
    CHECK(after("    material: water\n", "") == "E011@10 bodies[0]");
    CHECK(after("type: sample_block, ", "") == "E011@12 bodies[0].shape");
    CHECK(after(", max: [L, 0.1, H]", "") == "E011@12 bodies[0].shape");
    CHECK(after("name: p1, ", "") == "E011@19 probes[0]");
    CHECK(help_after("end_time: 2 s\n", "").find("a time such as 0.5 s") == 0);
  }

  TEST_CASE("E012: an unknown key suggests one that is not there yet") {
    CHECK(after("limiter", "limitr") == "E012@23 numerics");
    CHECK(help_after("limiter", "limitr") == "did you mean 'limiter'?");
    CHECK(help_after("end_time", "end_tme") == "did you mean 'end_time'?");
    CHECK(help_after("min: [0", "mn: [0") == "did you mean 'min'?");
    CHECK(help_after("type: sample_block", "typ: sample_block") == "did you mean 'type'?");
    CHECK(help_after("material: water", "Material: water") == "did you mean 'material'?");
    CHECK(after("limiter: 3", "limiter: 3\n  colour: red") == "E012@24 numerics");
  }

  TEST_CASE("E013: another dimension, or no unit at all") {
    CHECK(after("end_time: 2 s", "end_time: 2 m") == "E013@5 end_time");
    CHECK(after("density: 1 g/cm3", "density: 1 kPa") == "E013@8 materials[0].density");
    CHECK(after("H: 20 cm", "H: 20 cmm") == "E013@6 variables.H");
    CHECK(help_after("0.01 m", "0.01 mmm") == "did you mean 'mm'?");
    CHECK(after("limiter: 3", "limiter: 3 m") == "E013@23 numerics.limiter");
    CHECK(after("[0.1*z, 0]", "[1 kg, 0]") == "E013@13 bodies[0].velocity[0]");
    CHECK(after("gravity: 9.81", "gravity: 9.81 m/s") == "E013@4 gravity");
  }

  TEST_CASE("E014: out of range") {
    CHECK(after("0.01 m", "0") == "E014@3 resolution");
    CHECK(after("0.01 m", "-1 mm") == "E014@3 resolution");
    CHECK(help_after("0.01 m", "0") == "must be greater than 0 m");
    CHECK(after("dimension: 2", "dimension: 4") == "E014@2 dimension");
    CHECK(after("[L, 0.1, H]", "[101, 0.1, H]") == "E014@12 bodies[0].shape.max[0]");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], rounding: 0.1") == "E014@12 bodies[0].shape.rounding");
    CHECK(help_after("[L, 0.1, H]", "[L, 0.1, H], rounding: 0.1") ==
          "must be greater than 0 m and less than 0.1 m");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], layers: 0") == "E014@12 bodies[0].shape.layers");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], stops: [1, -1]") ==
          "E014@12 bodies[0].shape.stops[1]");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], roughness: -1") ==
          "E014@12 bodies[0].shape.roughness");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], roughness: 0*L-1") ==
          "E014@12 bodies[0].shape.roughness");
    // y plays no part in 2D, so its range does not bind there.
    CHECK(findings(with("[L, 0.1, H]", "[L, 101, H]")).empty());
  }

  TEST_CASE("E015: not one of the choices") {
    CHECK(after("limiter: 3", "outside: remov") == "E015@23 numerics.outside");
    CHECK(help_after("limiter: 3", "outside: remov") == "did you mean 'remove'?");
    CHECK(help_after("limiter: 3", "outside: keep") == "valid: remove and stop");
    CHECK(after("pressure: hydrostatic", "pressure: hydrostatik") == "E015@14 bodies[0].pressure");
    CHECK(help_after("pressure: hydrostatic", "pressure: hydrostatik") ==
          "did you mean 'hydrostatic'?");
  }

  TEST_CASE("E016: an unknown type says nothing about its keys") {
    CHECK(after("{type: sample_block, min", "{type: sample_blok, minn") ==
          "E016@12 bodies[0].shape.type");
    CHECK(help_after("type: sample_block", "type: sample_blok") == "did you mean 'sample_block'?");
    CHECK(after("type: sample_gauge", "type: sample_gaug") == "E016@19 probes[0].type");
  }

  TEST_CASE("E017: a formula that cannot be read, at the place in the formula") {
    CHECK(after("level: 2*H + 0.1", "level: 2*H + ") == "E017@15 bodies[0].level");
    CHECK(after("level: 2*H + 0.1", "level: 2*HH") == "E017@15 bodies[0].level");
    CHECK(findings(with("level: 2*H + 0.1", "level: 2*HH"))[0].place.column == 14);
    CHECK(help_after("level: 2*H + 0.1", "level: 2*HH") == "did you mean 'H'?");
    CHECK(help_after("level: 2*H + 0.1", "level: 2*x") == "only variables of the deck are");
    CHECK(after("0.5*t^2", "0.5*z") == "E017@17 boundaries[0].motion[2]");
    CHECK(after("0.5*t^2", "L*(t") == "E017@17 boundaries[0].motion[2]");
  }

  TEST_CASE("an unknown or failed variable is one error however often it is used") {
    CHECK(after("L: 0.4", "Q: 0.4") == "E017@6 variables.W");
    CHECK(after("L: 0.4", "L: 0.4 furlong") == "E013@6 variables.L");
  }

  TEST_CASE("E018: a file that is not there") {
    CHECK(after("motion: [0, 0, 0.5*t^2]", "table: no.csv") == "E018@17 boundaries[0].table");
  }

  TEST_CASE("E019: numbers that are none, or that readers disagree about") {
    for (const char* bad : {".inf", ".nan", "-.inf", "1e400", "1e-400", "010", "0x10", "1_0",
                            "1:30", "010 m", "1e308 km"}) {
      CAPTURE(bad);
      CHECK(after("resolution: 0.01 m", fmt::format("resolution: {}", bad)) == "E019@3 resolution");
    }
  }

  TEST_CASE("E020: the wrong number of elements") {
    CHECK(after("min: [0, 0, 0]", "min: [0]") == "E020@12 bodies[0].shape.min");
    CHECK(after("min: [0, 0, 0]", "min: [0, 0, 0, 0]") == "E020@12 bodies[0].shape.min");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], stops: [1]") == "E020@12 bodies[0].shape.stops");
    CHECK(after("[L, 0.1, H]", "[L, 0.1, H], stops: [1, 2, 3, 4]") ==
          "E020@12 bodies[0].shape.stops");
    CHECK(after("materials:\n  - {name: water, type: sample_liquid, density: 1 g/cm3}",
                "materials: []") == "E020@7 materials");
    const std::string solid = with("dimension: 2", "dimension: 3");
    const std::vector<Diagnostic> found = findings(solid);
    REQUIRE(found.size() == 2);  // velocity and the gauge's place have two components only
    CHECK(found[0].id == "E020");
    CHECK(found[1].id == "E020");
  }

  TEST_CASE("E021, E022, E024: names that refer to nothing, twice or not usable") {
    CHECK(after("material: water", "material: watr") == "E021@11 bodies[0].material");
    CHECK(help_after("material: water", "material: watr") == "did you mean 'water'?");
    CHECK(after("probe: p1.x", "probe: p2.x") == "E021@25 expect[0].probe");
    CHECK(after("name: gate", "name: column") == "E022@17 boundaries[0].name");
    CHECK(after("name: p1", "name: p1, type: sample_gauge, at: [0, 0]}\n  - {name: p1") ==
          "E022@20 probes[1].name");
    CHECK(after("name: gate", "name: a/b") == "E024@17 boundaries[0].name");
  }

  TEST_CASE("E023: names a variable may not have") {
    CHECK(after("H: 20 cm", "H: 20 cm, sin: 1") == "E023@6 variables");
    CHECK(after("H: 20 cm", "H: 20 cm, t: 1") == "E023@6 variables");
    CHECK(after("H: 20 cm", "H: 20 cm, a-b: 1") == "E023@6 variables");
  }

  TEST_CASE("E030: rules across keys, run only when the structure is sound") {
    CHECK(after("[L, 0.1, H]", "[L, 0.1, -H]") == "E030@12 bodies[0].shape.max");
    CHECK(after("pressure: hydrostatic", "pressure: zero") == "E030@15 bodies[0].level");
    CHECK(after("limiter: 3", "domain_min: [0, 0]\n  domain_max: [1, 0]") ==
          "E030@24 numerics.domain_max");
    CHECK(after("reference: 0.5, ", "") == "E030@25 expect[0]");
    CHECK(after("reduce: last", "reduce: curve").substr(0, 7) == "E030@25");
    CHECK(after("reduce: last", "reduce: at") == "E030@25 expect[0].reduce");
    CHECK(after("reduce: last", "at: 1") == "E030@25 expect[0].at");
    CHECK(after("tolerance: 1 %", "tolerance: -1") == "E030@25 expect[0].tolerance");
    CHECK(after("reference: 0.5", "reference: 0") == "E030@25 expect[0].reference");
    CHECK(after("tolerance: 1 %", "tolerance: 1, measure: below") == "E030@25 expect[0].reference");
    CHECK(after("reduce: last", "scale: 0") == "E030@25 expect[0].scale");
    CHECK(after("reduce: last", "from: 2, to: 1") == "E030@25 expect[0].to");
    // One structural error: the rule about the height is not asked.
    CHECK(findings(with("[L, 0.1, H]", "[L, 0.1, -H], colour: red")).size() == 1);
  }

  TEST_CASE("all errors come at once") {
    std::string text = with("limiter", "limitr");
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace("0.01 m", "0.01 s");
    replace("type: sample_gauge", "type: gauge");
    replace("title: Dam break", "title: a\ntitle: b");
    const std::vector<Diagnostic> found = findings(text, {"Q=1"});
    CHECK(found.size() == 5);
  }

  TEST_CASE("warnings stay in the model") {
    const Model m = read_deck_text(with("[L, 0.1, H]", "[L, 0.1, H], layers: 9"));
    REQUIRE(m.warnings.items().size() == 1);
    CHECK(m.warnings.items()[0].id == "W030");
    CHECK(m.warnings.items()[0].place.line == 12);
  }

  TEST_CASE("every misspelt key gets its line and the right suggestion") {
    const std::string deck = good_deck();
    int line = 1;
    int keys = 0;
    for (std::size_t k = 0; k < deck.size(); ++k) {
      if (deck[k] == '\n') ++line;
      const bool starts = k == 0 || deck[k - 1] == '\n' || deck[k - 1] == ' ' || deck[k - 1] == '{';
      std::size_t end = k;
      while (end < deck.size() && ((deck[end] >= 'a' && deck[end] <= 'z') || deck[end] == '_'))
        ++end;
      if (!starts || end < k + 2 || deck.compare(end, 1, ":") != 0) continue;
      const std::string key = deck.substr(k, end - k);
      ++keys;
      std::string wrong = deck;
      wrong.replace(k + key.size() / 2, 1, "q");
      const std::vector<Diagnostic> found = findings(wrong);
      CAPTURE(key);
      CAPTURE(line);
      REQUIRE(found.size() == 1);
      CHECK(found[0].id == "E012");
      CHECK(found[0].place.line == line);
      CHECK(found[0].help == fmt::format("did you mean '{}'?", key));
    }
    CHECK(keys > 35);
  }

  TEST_CASE("a comma in braces and a number in a path are explained") {
    const auto help_of = [](const std::string& text, const std::vector<std::string>& set) {
      try {
        read_deck_text(text, set);
      } catch (const DeckError& e) {
        return e.diagnostics.items().at(0).help;
      }
      return std::string();
    };
    const std::string deck =
        "dimension: 2\nresolution: 0.1\nend_time: 1\nmaterials: [{name: water, type: water";
    CHECK(help_of(deck + ", max_speed: 1,5}]\n", {}).find("begins a new key") != std::string::npos);
    CHECK(help_of(deck + "}]\n", {"materials.0.density=900"}) ==
          "an element by its number is written 'materials[0]'");
  }
}
