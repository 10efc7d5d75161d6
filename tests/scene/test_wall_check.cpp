#include "scene/wall_check.h"

#include <doctest/doctest.h>

#include <fstream>
#include <set>
#include <string>

#include "output/temporary_folder.h"
#include "support/rig.h"

using namespace sphgeo;

namespace {

using Ids = std::multiset<std::string>;

// Ids of the findings about the boundaries of a scene.
template <int Dim = 2>
Ids findings(const std::string& rest) {
  const Model model =
      read_deck_text("dimension: " + std::to_string(Dim) + "\nresolution: 0.05\nend_time: 1\n" +
                         "materials: [{name: water, type: water, max_speed: 5}]\n" + rest,
                     {}, "deck", SPHGEO_SOURCE_DIR);
  Diagnostics found;
  const Scene<Dim> scene = build_scene<Dim>(model, found);
  check_walls(scene, found);
  Ids ids;
  for (const Diagnostic& d : found.items()) {
    ids.insert(d.id);
    CHECK(d.place.line > 0);
  }
  return ids;
}

const std::string pool =
    "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, "
    "0.3]}}]\n";

std::string wall(const std::string& name, const std::string& shape, const std::string& more = "") {
  return "  - {name: " + name + ", type: wall, shape: " + shape + more + "}\n";
}
std::string box(const std::string& min, const std::string& max) {
  return "{type: box, min: [" + min + "], max: [" + max + "]}";
}
const std::string ground = "boundaries:\n" + wall("floor", box("-1, 0, -0.2", "2, 1, 0"));

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("a wall too thin to hold a particle is an error") {
    CHECK(findings(pool + ground).empty());
    CHECK(findings(pool + ground + wall("sheet", box("0.5, 0, 0", "0.52, 1, 0.5"))) == Ids{"E143"});
    CHECK(findings(pool + ground +
                   "  - {name: sides, type: tank, min: [0, 0, 0], max: [1, 1, 1], open: [left, "
                   "right, bottom, top]}\n")
              .empty());
  }

  TEST_CASE(
      "a box-shaped wall that is no multiple of the spacing is found, in the plane of the scene") {
    CHECK(findings(pool + ground + wall("stop", box("0.5, 0, 0", "0.72, 1, 0.5"))) == Ids{"W122"});
    CHECK(findings(pool + ground + wall("stop", box("0.5, 0, 0", "0.7, 1.02, 0.5"))).empty());
    CHECK(findings<3>(pool + ground + wall("stop", box("0.5, 0, 0", "0.7, 1.02, 0.5"))) ==
          Ids{"W122"});
  }

  TEST_CASE("a wall that holds one layer only is said to leak, however it is described") {
    const auto plate = [](double thickness) {
      return pool + ground +
             wall("plate", box("0.5, 0, 0", std::to_string(0.5 + thickness) + ", 1, 0.5"));
    };
    CHECK(findings(plate(0.05)) == Ids{"W149"});
    CHECK(findings<3>(plate(0.05)) == Ids{"W149"});
    CHECK(findings(plate(0.1)).empty());
    CHECK(findings(pool + ground +
                   wall("plate",
                        "{type: polygon, points: [[0.5, 0, 0], [0.55, 0, 0], [0.55, 0, 0.5], "
                        "[0.5, 0, 0.5]], y_min: 0, y_max: 1}")) == Ids{"W149"});
    CHECK(
        findings(pool + ground +
                 wall("plate", "{type: transform, rotate: 30 deg, translate: [0.7, 0, 0.1], of: " +
                                   box("0, 0, 0", "0.06, 1, 0.5") + "}")) == Ids{"W149"});
    // Two halves of one wall are as thick as both; a wedge is thin at its tip only.
    CHECK(findings(pool + ground + wall("left", box("0.5, 0, 0", "0.55, 1, 0.5")) +
                   wall("right", box("0.55, 0, 0", "0.6, 1, 0.5")))
              .empty());
    CHECK(findings(pool + ground +
                   wall("wedge",
                        "{type: polygon, points: [[0.5, 0, 0], [1.3, 0, 0], [1.3, 0, 0.5]], "
                        "y_min: 0, y_max: 1}"))
              .empty());
    CHECK(
        findings(pool + "boundaries: [{name: sides, type: tank, min: [0, 0, 0], max: [1, 1, 1]}]\n")
            .empty());
  }

  TEST_CASE("an inlet that nothing closes from behind is told, unless water falls from it") {
    const auto inlet = [](const std::string& min, const std::string& max, const std::string& v) {
      return pool + ground + "  - {name: jet, type: inlet, min: [" + min + "], max: [" + max +
             "], velocity: [" + v + "]}\n";
    };
    const std::string beside = inlet("0, 0, 0.3", "0, 0.2, 0.5", "1, 0, 0");
    CHECK(findings(beside) == Ids{"N153"});
    CHECK(findings(inlet("0.1, 0, 0.6", "0.3, 0.2, 0.6", "0, 0, -1")).empty());
    CHECK(findings(inlet("0.1, 0, 0", "0.3, 0.2, 0", "0, 0, 1")).empty());  // the floor
    CHECK(findings(beside + wall("back", box("-0.3, 0, 0", "-0.05, 1, 0.6"))).empty());
    CHECK(findings(beside + wall("half", box("-0.3, 0, 0", "-0.05, 1, 0.4"))) == Ids{"N153"});
  }

  TEST_CASE("soil and bodies deep in a solid are found as water is") {
    for (const std::string material :
         {"{name: it, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e6, "
          "friction_angle: 30 deg}",
          "{name: it, type: rigid, density: 2500}"}) {
      const Model model = read_deck_text(
          "dimension: 2\nresolution: 0.05\nend_time: 1\nmaterials: [" + material +
          "]\nbodies: [{name: it, material: it, shape: " + box("0, 0, 0", "0.5, 1, 0.3") +
          "}]\nboundaries:\n" + wall("rock", box("-1, -1, -1", "2, 2, 2")));
      Diagnostics found;
      const Scene<2> scene = build_scene<2>(model, found);
      check_walls(scene, found);
      REQUIRE(found.items().size() == 1);
      CHECK(found.items()[0].id == "E121");
      CHECK(found.items()[0].path == "bodies[0].shape");
    }
  }

  TEST_CASE(
      "bodies in walls are found when the wall moves, and when they are finer than the wall") {
    const auto ids = [](const std::string& body, const std::string& wall) {
      const Model model = read_deck_text(
          "dimension: 2\nresolution: 0.02\nend_time: 1\n"
          "materials: [{name: stone, type: rigid, density: 2500}]\nbodies: [{name: b, material: "
          "stone, " +
          body + "}]\nboundaries: [{name: floor, type: wall, shape: " +
          box("-0.5, -1, -0.3", "0.5, 1, 0") + wall + "}]\n");
      Diagnostics found;
      const Scene<2> scene = build_scene<2>(model, found);
      check_walls(scene, found);
      Ids out;
      for (const Diagnostic& d : found.items()) out.insert(d.id);
      return out;
    };
    const std::string deep = "shape: {type: sphere, center: [0.4, 0, -0.15], radius: 0.04}";
    CHECK(ids(deep, "") == Ids{"E121"});
    CHECK(ids(deep, ", motion: {displacement: [0.05 + t, 0, 0]}") == Ids{"E121"});
    CHECK(ids(deep, ", motion: {displacement: [0, 0, -0.3 + t]}").empty());  // above it at first
    const auto fine = [](const std::string& bottom) {
      return "spacing: 0.005, shape: " + box("0, -1, " + bottom, "0.05, 1, 0.04");
    };
    CHECK(ids(fine("-0.01"), "") == Ids{"E121"});
    CHECK(ids(fine("0"), "").empty());
  }

  TEST_CASE("water deep in a solid is found, where no wall particle is") {
    CHECK(findings(pool + "boundaries:\n" + wall("rock", box("-1, -1, -1", "2, 2, 2"))) ==
          Ids{"E121"});
    CHECK(findings(pool + ground +
                   wall("high", box("-1, 0, 1", "2, 1, 2"), ", motion: {displacement: [0, 0, -t]}"))
              .empty());
    // It has gone elsewhere at t = 0.
    CHECK(findings(
              pool + ground +
              wall("block", box("-1, -1, 0", "2, 2, 2"), ", motion: {displacement: [0, 0, 1 + t]}"))
              .empty());
  }

  TEST_CASE("boundaries that overlap are joined, which is no fault") {
    CHECK(findings(pool + ground + wall("left", box("-0.2, 0, 0", "0, 1, 0.5"))).empty());
    CHECK(findings(pool + ground + wall("left", box("-0.2, 0, -0.1", "0, 1, 0.5"))).empty());
  }

  TEST_CASE("a probe below the surface of a boundary is found, one on it is not") {
    const auto probe = [](const std::string& at) {
      return "probes: [{name: p, type: pressure, at: [" + at + "]}]\n";
    };
    CHECK(findings(pool + ground + probe("0.2, 0, 0")).empty());
    CHECK(findings(pool + ground + probe("0.2, 0, -0.02")).empty());
    CHECK(findings(pool + ground + probe("0.2, 0, -0.03")) == Ids{"W128"});
  }

  TEST_CASE("a resting body with nothing below it is found when the scene has boundaries") {
    const std::string beside = "boundaries:\n" + wall("floor", box("1, 0, -0.2", "2, 1, 0"));
    CHECK(findings(pool).empty());
    CHECK(findings(pool + beside) == Ids{"W129"});
    CHECK(findings("gravity: 0\n" + pool + beside).empty());
    std::string jet = pool;
    jet.replace(jet.find("}}]"), 3, "}, velocity: [2, 0, 0]}]");
    CHECK(findings(jet + beside).empty());
  }

  TEST_CASE("the surface of an STL boundary is inspected") {
    CHECK(findings<3>("bodies: [{name: drop, material: water, shape: " +
                      box("-0.1, -0.1, 0.5", "0.1, 0.1, 0.7") + "}]\nboundaries:\n" +
                      wall("ball", "{type: stl, file: share/assets/ball.stl, scale: 2}"))
              .empty());
    // A tetrahedron without one of its faces.
    const test::TemporaryFolder folder;
    std::ofstream(folder / "open.stl") << "solid s\n"
                                          "facet normal 0 0 -1 outer loop vertex 0 0 0 vertex 0 1 "
                                          "0 vertex 1 0 0 endloop endfacet\n"
                                          "facet normal 0 -1 0 outer loop vertex 0 0 0 vertex 1 0 "
                                          "0 vertex 0 0 1 endloop endfacet\n"
                                          "facet normal -1 0 0 outer loop vertex 0 0 0 vertex 0 0 "
                                          "1 vertex 0 1 0 endloop endfacet\n"
                                          "endsolid s\n";
    CHECK(findings<3>("bodies: [{name: drop, material: water, shape: " +
                      box("0.1, 0.1, 2", "0.3, 0.3, 2.2") + "}]\nboundaries:\n" +
                      wall("tent", "{type: stl, file: " + (folder / "open.stl") + "}"))
              .contains("E030"));
  }
}
