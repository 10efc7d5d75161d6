#include "scene/build.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "plan/plan.h"
#include "scene/cross_check.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string deck(const std::string& material, const std::string& rest, int dimension = 2) {
  return "dimension: " + std::to_string(dimension) + "\nresolution: 0.05\nend_time: 2\n" +
         "materials: [{name: water, type: water" + material + "}]\n" + rest;
}

const std::string pool =
    "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, "
    "0.3]}}]\n";
const std::string tank =
    "boundaries: [{name: tank, type: tank, min: [0, 0, -0.1], max: [0.5, 0.2, 0.5], open: "
    "[top]}]\n";

template <int Dim>
SoundSpeed sound(const std::string& material, const std::string& rest) {
  return Rig<Dim>(deck(material, rest, Dim)).scene.sound;
}

// Ids of all findings of building and checking, in order of id.
template <int Dim = 2>
std::multiset<std::string> findings(const std::string& rest, const std::string& material = "") {
  const Model model = read_deck_text(deck(material, rest, Dim));
  Diagnostics found;
  const Scene<Dim> scene = build_scene<Dim>(model, found);
  check_scene(scene, found);
  std::multiset<std::string> ids;
  for (const Diagnostic& d : found.items()) {
    ids.insert(d.id);
    CHECK_FALSE(d.message.empty());
    CHECK_FALSE(d.path.empty());
    CHECK(d.place.line > 0);
  }
  return ids;
}
using Ids = std::multiset<std::string>;

std::string body(const std::string& name, const std::string& shape, const std::string& more = "") {
  return "  - {name: " + name + ", material: water, shape: " + shape + more + "}\n";
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("the speed of sound is given, or ten times the largest speed to be expected") {
    CHECK(sound<2>(", sound_speed: 42", pool).value == 42.0);
    CHECK(sound<2>(", max_speed: 3", pool).value == doctest::Approx(30));
    // A dam break: front speed 2 sqrt(g H) from the top of the water down to the floor of the tank.
    const SoundSpeed fall = sound<2>("", pool + tank);
    CHECK(fall.max_speed == doctest::Approx(2 * std::sqrt(9.81 * 0.4)));
    CHECK(fall.value == doctest::Approx(20 * std::sqrt(9.81 * 0.4)));
    CHECK(fall.because.find("0.4 m") != std::string::npos);
    CHECK(sound<3>("", pool + tank).value == fall.value);
    CHECK(sound<2>("", pool).value == doctest::Approx(20 * std::sqrt(9.81 * 0.3)));
  }

  TEST_CASE("initial speed, initial pressure and moving walls raise the speed of sound") {
    const std::string still = "gravity: 0\n";
    std::string fast = pool;
    fast.replace(fast.find("}}]"), 3, "}, velocity: [6*x, 0, 8*x]}]");
    CHECK(sound<2>("", still + fast).max_speed == doctest::Approx(5));
    CHECK(sound<2>("", still + fast).because.find("'pool'") != std::string::npos);
    std::string pressed = pool;
    pressed.replace(pressed.find("}}]"), 3, "}, pressure: 2000*z/0.3}]");
    CHECK(sound<2>("", still + pressed).max_speed == doctest::Approx(2));
    CHECK(sound<2>("", still + pool +
                           "boundaries: [{name: piston, type: wall, shape: {type: box, min: [-0.5, "
                           "0, 0], max: [0, 0.2, 0.3]}, "
                           "motion: {displacement: [7*t, 0, 0]}}]\n")
              .max_speed == doctest::Approx(7));
  }

  TEST_CASE("a scene in which nothing can move has no speed of sound to estimate") {
    CHECK(findings("gravity: 0\n" + pool) == Ids{"E112"});
    CHECK(findings("gravity: 0\n" + pool, ", max_speed: 1").empty());
  }

  TEST_CASE(
      "lattice_jitter moves particles by no more than it says, another seed otherwise, and no body "
      "as another") {
    const auto places = [](const std::string& numerics) {
      const std::string two =
          "bodies:\n  - {name: a, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, "
          "0.2, 0.3]}}\n"
          "  - {name: b, material: water, shape: {type: box, min: [1, 0, 0], max: [1.5, 0.2, "
          "0.3]}}\n";
      Rig<2> rig(deck("", two + numerics));
      const auto& x = rig.water().vector(fields::position);
      std::vector<Vec<2>> out;
      for (Index k = 0; k < rig.water().size(); ++k) out.push_back(x[k]);
      return out;
    };
    const auto lattice = places(""), jittered = places("numerics: {lattice_jitter: 0.1}");
    const auto other = places("numerics: {lattice_jitter: 0.1, lattice_seed: 2}");
    REQUIRE(lattice.size() == 120);
    double largest = 0;
    bool bodies_alike = true, seeds_alike = true;
    for (std::size_t k = 0; k < lattice.size(); ++k) {
      largest = std::max(largest, (jittered[k] - lattice[k]).cwiseAbs().maxCoeff());
      seeds_alike = seeds_alike && jittered[k] == other[k];
      if (k < 60)
        bodies_alike =
            bodies_alike &&
            (jittered[k] - lattice[k] - jittered[k + 60] + lattice[k + 60]).norm() < 1e-12;
    }
    CHECK(largest <= 0.1 * 0.05 + 1e-12);
    CHECK(largest > 0.09 * 0.05);
    CHECK_FALSE(seeds_alike);
    CHECK_FALSE(bodies_alike);
    CHECK(places("numerics: {lattice_jitter: 0.1}") == jittered);
  }

  TEST_CASE(
      "an effect is switched off with a warning, an unknown one or one that is needed not at all") {
    CHECK(findings(pool + tank + "without: [drag]\n") == std::multiset<std::string>{"W140"});
    CHECK(findings(pool + tank + "without: [water_momentum]\n") ==
          std::multiset<std::string>{"E141"});
    CHECK(findings(pool + tank + "without: [drga]\n") == std::multiset<std::string>{"E141"});
  }

  TEST_CASE("a sound scene has no findings") {
    CHECK(findings(pool + tank).empty());
    CHECK(findings<3>(pool + tank).empty());
    CHECK(findings(pool + tank +
                   "probes: [{name: a, type: pressure, at: [0.5, 0.1, 0]}, {name: b, type: force, "
                   "boundary: tank}]\n")
              .empty());
  }

  TEST_CASE("bodies that overlap are found, bodies that touch are not") {
    const std::string left =
        "bodies:\n" + body("left", "{type: box, min: [0, 0, 0], max: [0.5, 0.2, 0.3]}");
    CHECK(findings(left + body("right", "{type: box, min: [0.5, 0, 0], max: [1, 0.2, 0.3]}"))
              .empty());
    CHECK(findings(left + body("right", "{type: box, min: [0.4, 0, 0], max: [1, 0.2, 0.3]}")) ==
          Ids{"E120"});
    CHECK(findings<3>(left +
                      body("right", "{type: sphere, center: [0.25, 0.1, 0.15], radius: 0.1}")) ==
          Ids{"E120"});
  }

  TEST_CASE("water in a solid, solids in each other and in walls, and keys that only solids have") {
    const std::string rock =
        ", max_speed: 5}, {name: rock, type: rigid, density: 2000}, {name: rubber, type: elastic, "
        "density: 1000, youngs_modulus: 1e6";
    const auto solid = [](const std::string& name, const std::string& shape,
                          const std::string& more = "") {
      return "  - {name: " + name + ", material: rubber, shape: " + shape + more + "}\n";
    };
    const std::string left =
        "bodies:\n" + solid("left", "{type: box, min: [0, 0, 0], max: [0.5, 0.2, 0.3]}");
    CHECK(findings(left + solid("right", "{type: box, min: [0.5, 0, 0], max: [1, 0.2, 0.3]}"), rock)
              .empty());
    CHECK(findings(left + solid("right", "{type: box, min: [0.4, 0, 0], max: [1, 0.2, 0.3]}"),
                   rock) == Ids{"E120"});
    CHECK(findings(left + body("pool", "{type: box, min: [0.4, 0, 0], max: [1, 0.2, 0.3]}"),
                   rock) == Ids{"E120"});
    const std::string floor =
        "boundaries: [{name: floor, type: wall, shape: {type: box, min: [-1, 0, -0.2], max: [1, 1, "
        "0.1]}}]\n";
    CHECK(findings(left + floor, rock) == Ids{"E121"});
    const std::string foot =
        "bodies:\n" + solid("plate", "{type: box, min: [0, 0, 0], max: [0.2, 0.2, 0.3]}",
                            ", clamped: [{shape: {type: half_space, point: [0, 0, 0.1]}}]");
    CHECK(findings(foot + floor, rock).empty());
    CHECK(findings("bodies:\n" + body("pool", "{type: box, min: [0, 0, 0], max: [0.5, 0.2, 0.3]}",
                                      ", spacing: 0.05, self_contact: true"),
                   rock) == Ids{"E119", "E119"});
  }

  TEST_CASE("water in a wall is found") {
    CHECK(findings(
              pool +
              "boundaries: [{name: tank, type: tank, min: [0.1, 0, 0], max: [0.5, 0.2, 0.5]}]\n") ==
          Ids{"E121"});
    CHECK(findings(pool + tank.substr(0, tank.size() - 2) +
                   ", {name: sill, type: wall, shape: {type: box, min: [0.2, 0, 0], max: [0.3, 1, "
                   "0.1]}}]\n") == Ids{"E121"});
  }

  TEST_CASE("lengths that are no multiple of the spacing, probes outside, probes without a set") {
    CHECK(findings("bodies:\n" + body("b", "{type: box, min: [0, 0, 0], max: [0.52, 0.2, 0.3]}")) ==
          Ids{"W122"});
    CHECK(findings("bodies:\n" + body("b", "{type: box, min: [0, 0, 0], max: [0.5, 0.22, 0.3]}"))
              .empty());  // y in 2D
    CHECK(findings<3>("bodies:\n" +
                      body("b", "{type: box, min: [0, 0, 0], max: [0.52, 0.22, 0.3]}")) ==
          Ids{"W122", "W122"});
    CHECK(findings(pool + "probes: [{name: far, type: pressure, at: [3, 0, 0.1]}]\n") ==
          Ids{"W123"});
    CHECK(findings(pool + "probes: [{name: p, type: amount, set: soil}]\n") == Ids{"E124"});
    CHECK(findings(pool + "probes: [{name: p, type: force, boundary: tank}]\n") == Ids{"E030"});
    CHECK(findings(pool + "probes: [{name: p, type: mean, field: stress.xx}]\n") == Ids{"E125"});
    CHECK(findings(pool + "probes: [{name: p, type: sum, of: [q]}]\n") == Ids{"E030"});
  }

  TEST_CASE("empty bodies and formulas that are no numbers are found") {
    CHECK(findings("bodies:\n" +
                   body("b", "{type: sphere, center: [0.051, 0, 0.051], radius: 0.01}")) ==
          Ids{"E110"});
    CHECK(findings("bodies:\n" + body("b", "{type: box, min: [0, 0, 0], max: [0.5, 1, 0.5]}",
                                      ", velocity: [sqrt(x - 0.2), 0, 0]")) == Ids{"E111"});
  }

  TEST_CASE("the initial density follows the hydrostatic pressure") {
    for (const bool raised : {false, true}) {
      std::string text = pool;
      text.replace(
          text.find("}}]"), 3,
          raised ? "}, pressure: hydrostatic, level: 0.2}]" : "}, pressure: hydrostatic}]");
      Rig<2> rig(deck(", sound_speed: 30, density: 900", text));
      const double level = raised ? 0.2 : 0.3;
      for (Index i = 0; i < rig.water().size(); ++i) {
        const double z = rig.water().vector(fields::position)[i][1];
        CHECK(rig.water().scalar(fields::density)[i] ==
              doctest::Approx(900 + std::max(0.0, 900 * 9.81 * (level - z)) / 900).epsilon(1e-12));
      }
    }
    std::string formula = pool;
    formula.replace(formula.find("}}]"), 3, "}, pressure: 1e3*x}]");
    Rig<2> rig(deck(", sound_speed: 10", formula));
    const Index i = test::particle_at<2>(rig.water(), {0.225, 0.125});
    REQUIRE(i >= 0);
    CHECK(rig.water().scalar(fields::density)[i] == doctest::Approx(1000 + 225.0 / 100));
  }

  TEST_CASE("the same deck builds in 2D and in 3D") {
    const std::string rest = pool + tank;
    Rig<2> flat(deck("", rest, 2));
    Rig<3> deep(deck("", rest, 3));
    CHECK(flat.water().size() == 10 * 6);
    CHECK(deep.water().size() == 10 * 4 * 6);
    CHECK(flat.scene.sound.value == deep.scene.sound.value);
    CHECK(flat.water().scalar(fields::mass)[0] == doctest::Approx(1000 * 0.05 * 0.05));
    CHECK(deep.water().scalar(fields::mass)[0] == doctest::Approx(1000 * 0.05 * 0.05 * 0.05));
    std::set<std::pair<long, long>> a, b;
    const auto key = [](double x, double z) {
      return std::pair(std::lround(x / 1e-6), std::lround(z / 1e-6));
    };
    for (Index i = 0; i < flat.water().size(); ++i)
      a.insert(key(flat.water().vector(fields::position)[i][0],
                   flat.water().vector(fields::position)[i][1]));
    for (Index i = 0; i < deep.water().size(); ++i)
      b.insert(key(deep.water().vector(fields::position)[i][0],
                   deep.water().vector(fields::position)[i][2]));
    CHECK(a == b);
    CHECK(a.size() == 60);
    CHECK(flat.scene.body_particles.size() == 1);
    CHECK(flat.scene.body_particles[0].particles == 60);
    CHECK(flat.scene.boundary_particles[0].second == flat.walls().size());
  }

  TEST_CASE("several bodies and boundaries: parts, ids and masses") {
    Rig<2> rig(deck(", density: 800",
                    "bodies:\n" +
                        body("a", "{type: box, min: [0, 0, 0], max: [0.2, 1, 0.2]}",
                             ", velocity: [1, 0, 2*z]") +
                        body("b", "{type: box, min: [0.5, 0, 0], max: [0.6, 1, 0.2]}") + tank));
    REQUIRE(rig.water().size() == 16 + 8);
    for (Index i = 0; i < rig.water().size(); ++i) {
      CHECK(rig.water().ids()[i] == static_cast<Id>(i));
      CHECK(rig.water().tag(fields::part)[i] == (i < 16 ? 0 : 1));
      CHECK(rig.water().scalar(fields::mass)[i] == doctest::Approx(800 * 0.0025));
      const double z = rig.water().vector(fields::position)[i][1];
      CHECK((rig.water().vector(fields::velocity)[i] - (i < 16 ? Vec<2>(1, 2 * z) : Vec<2>(0, 0)))
                .norm() < 1e-14);
    }
  }
  TEST_CASE("soil and water in one scene: a warning that they do not act on each other") {
    const Model model = read_deck_text(R"(
dimension: 2
resolution: 0.05
end_time: 1
materials:
  - {name: water, type: water, max_speed: 5}
  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 5e6,
      friction_angle: 30 deg}
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, 0.3]}}
  - {name: bank, material: sand, shape: {type: box, min: [0.5, 0, 0], max: [1, 0.2, 0.3]}}
)",
                                       {}, "deck", SPHGEO_SOURCE_DIR);
    Diagnostics found;
    const Scene<2> scene = build_scene<2>(model, found);
    check_scene(scene, found);
    REQUIRE(found.items().size() == 1);
    CHECK(found.items()[0].id == "W130");
  }

  TEST_CASE(
      "soil that starts too near to an oblique wall: a warning that it is pushed; none along the "
      "lattice") {
    for (const bool oblique : {false, true}) {
      CAPTURE(oblique);
      const std::string turn = oblique ? "17 deg" : "0 deg";
      const Model model =
          read_deck_text(R"(
dimension: 2
resolution: 0.05
end_time: 1
materials: [{name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 5e6,
    friction_angle: 30 deg}]
bodies:
  - name: bank
    material: sand
    filling: relaxed
    shape: {type: transform, rotate: )" +
                             turn + R"(, of: {type: box, min: [0, 0, 0], max: [1, 0.2, 0.3]}}
boundaries:
  - name: slope
    type: wall
    shape: {type: transform, rotate: )" +
                             turn + R"(, of: {type: box, min: [-0.5, 0, -0.5], max: [1.5, 0.2, 0]}}
)",
                         {}, "deck", SPHGEO_SOURCE_DIR);
      Diagnostics found;
      const Scene<2> scene = build_scene<2>(model, found);
      check_scene(scene, found);
      const auto& x = scene.world->set("soil").vector(fields::position);
      const auto& y = scene.world->set("walls").vector(fields::position);
      int near = 0;
      for (Index i = 0; i < x.size(); ++i) {
        bool close = false;
        for (Index j = 0; j < y.size(); ++j) close = close || (x[i] - y[j]).norm() < 0.7 * 0.05;
        near += close ? 1 : 0;
      }
      bool warned = false;
      for (const Diagnostic& d : found.items()) {
        CHECK(d.id == "W134");
        CAPTURE(d.message);
        CAPTURE(near);
        CHECK(d.message.find(": " + std::to_string(near) + " of its particles") !=
              std::string::npos);
        CHECK(d.place.line > 0);
        warned = true;
      }
      CHECK(warned == oblique);
    }
  }

  TEST_CASE(
      "an acoustic step too long for all: a warning; too long for a light rigid body: its own "
      "bound") {
    const auto scene_of = [](const std::string& density, const std::string& cfl) {
      return read_deck_text(R"(
dimension: 2
resolution: 0.04
end_time: 1
numerics: {cfl_acoustic: )" + cfl +
                                R"(}
materials:
  - {name: water, type: water, max_speed: 5}
  - {name: foam, type: rigid, density: )" +
                                density + R"(}
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.8, 0.2, 0.4]}}
  - {name: float, material: foam, shape: {type: box, min: [0.2, 0, 0.48], max: [0.4, 0.2, 0.68]}}
)",
                            {}, "deck", SPHGEO_SOURCE_DIR);
    };
    const auto warned = [&](const std::string& cfl) {
      const Model model = scene_of("2600", cfl);
      Diagnostics found;
      check_scene(build_scene<2>(model, found), found);
      for (const Diagnostic& d : found.items())
        if (d.id == "W136") return d.help;
      return std::string("silent");
    };
    CHECK(warned("0.4") == "silent");
    CHECK(warned("0.95") == "most hold at 0.8 or less");

    const auto limits = [&](const std::string& density) {
      const Model model = scene_of(density, "0.4");
      Diagnostics found;
      Scene<2> scene = build_scene<2>(model, found);
      Plan<2> plan(*scene.world, {});
      scene.world->rearrange();
      return plan.limits();
    };
    CHECK(std::string(limits("2600").acoustic_by) == "sound in water");
    CHECK(limits("2600").acoustic == doctest::Approx(0.4 * 1.8 * 0.04 / 50));
    CHECK(std::string(limits("20").acoustic_by) == "a solid lighter than what touches it");
    // dp 0.04 m, L = 1000 dp / (20 * 0.2 m) = 10
    CHECK(limits("20").acoustic == doctest::Approx(0.8 * 0.04 / 50 / std::sqrt(10)));
  }
}
