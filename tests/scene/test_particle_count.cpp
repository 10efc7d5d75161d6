#include <doctest/doctest.h>

#include "scene/build.h"
#include "scene/particle_count.h"

using namespace sphgeo;

namespace {

const char* const scene_2d =
    "dimension: 2\nresolution: 0.02\ngravity: 9.81\nend_time: 1\n"
    "materials: [{name: water, type: water}]\n"
    "bodies:\n"
    "  - {name: column, material: water, shape: {type: box, min: [0, 0, 0], max: [0.6, 0.4, "
    "0.8]}}\n"
    "  - {name: drop, material: water, shape: {type: sphere, center: [1.2, 0.2, 0.6], radius: "
    "0.3}}\n"
    "boundaries:\n"
    "  - {name: tank, type: tank, min: [0, 0, 0], max: [2, 0.4, 1.2], open: [top]}\n"
    "  - {name: sill, type: wall, shape: {type: cylinder, from: [1.2, -0.1, 0], to: [1.2, 0.5, 0], "
    "radius: 0.15}}\n";

template <int Dim>
void compare(const Model& model) {
  Diagnostics found;
  const Scene<Dim> scene = build_scene<Dim>(model, found);
  const ParticleCounts expected = expected_particles(model);
  REQUIRE(expected.size() == scene.world->sets().size());
  for (const auto& set : scene.world->sets()) {
    CAPTURE(set->name());
    CHECK(count_of(expected, set->name()) ==
          doctest::Approx(static_cast<double>(set->size())).epsilon(0.03));
  }
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("particles are counted to a few percent without placing them") {
    compare<2>(read_deck_text(scene_2d));
    compare<2>(read_deck_text(scene_2d, {"resolution=0.005"}));
    compare<3>(read_deck_text(scene_2d, {"dimension=3"}));
  }

  TEST_CASE("solids of their own spacing and their interface are counted too") {
    std::string scene = scene_2d;
    scene.replace(scene.find("type: water}]"), 13,
                  "type: water}, {name: rock, type: rigid, density: 2500}]");
    scene.insert(scene.find("boundaries:"),
                 "  - {name: boulder, material: rock, spacing: resolution/2, shape: {type: sphere, "
                 "center: [1.0, 0.2, 1.1], radius: 0.12}}\n");
    compare<2>(read_deck_text(scene));
    compare<3>(read_deck_text(scene, {"dimension=3"}));
  }

  TEST_CASE("a tank without a body besides is counted exactly") {
    for (const char* dimension : {"dimension=2", "dimension=3"}) {
      const Model model = read_deck_text(
          "dimension: 2\nresolution: 0.03\ngravity: 9.81\nend_time: 1\nmaterials: [{name: water, "
          "type: water, sound_speed: 10}]\n"
          "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.4, 0.7], open: [top, "
          "left]}]\n",
          {dimension});
      Diagnostics found;
      const double placed =
          model.dimension == 2
              ? static_cast<double>(build_scene<2>(model, found).world->set("walls").size())
              : static_cast<double>(build_scene<3>(model, found).world->set("walls").size());
      CHECK(count_of(expected_particles(model), "walls") == placed);
    }
  }

  TEST_CASE("a count far beyond what can be placed is a number, and quick") {
    const Model model = at_resolution(read_deck_text(scene_2d, {"dimension=3"}), 1e-7);
    CHECK(total_of(expected_particles(model)) ==
          doctest::Approx((0.6 * 0.4 * 0.8 + 4.0 / 3 * 3.14159 * 0.027) * 1e21).epsilon(0.05));
  }
}
