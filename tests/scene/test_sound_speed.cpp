#include <doctest/doctest.h>

#include <cmath>

#include "scene/build.h"
#include "support/rig.h"

using namespace sphgeo;

namespace {

const std::string still_pool =
    "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, "
    "0.3]}}]\n";

std::string pool_deck(const std::string& material, const std::string& rest) {
  return "dimension: 2\nresolution: 0.05\nend_time: 2\nmaterials: [{name: water, type: water" +
         material + "}]\n" + still_pool + rest;
}

SoundSpeed sound_with(const std::string& rest) {
  return test::Rig<2>(pool_deck("", rest)).scene.sound;
}

/// The findings of building a pool whose water has these keys, by id.
std::string ids_with(const std::string& material) {
  const Model model = read_deck_text(
      pool_deck(material,
                "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.2, "
                "0.5], open: [top]}]\n"));
  Diagnostics found;
  build_scene<2>(model, found);
  std::string ids;
  for (const Diagnostic& d : found.items()) ids += d.id + " ";
  return ids;
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("heights are those along gravity, and inlets count") {
    // Gravity along -x: the pool is 0.5 m high.
    CHECK(sound_with("gravity: [-9.81, 0, 0]\n").max_speed ==
          doctest::Approx(2 * std::sqrt(9.81 * 0.5)));
    const double s = 9.81 * std::sqrt(0.5);
    CHECK(sound_with("gravity: [" + std::to_string(-s) + ", 0, " + std::to_string(-s) + "]\n")
              .max_speed == doctest::Approx(2 * std::sqrt(s * 0.8)).epsilon(1e-5));
    const SoundSpeed jet = sound_with(
        "gravity: 0\nboundaries: [{name: jet, type: inlet, min: [0, 0, 0], max: [0, 0.2, 0.2], "
        "velocity: [7, 0, 0]}]\n");
    CHECK(jet.max_speed == doctest::Approx(7));
    CHECK(jet.because.find("'jet'") != std::string::npos);
  }

  TEST_CASE("water that its speed of sound lets be compressed is warned of, or refused") {
    CHECK(ids_with(", sound_speed: 20").find("W137") == std::string::npos);
    CHECK(ids_with(", max_speed: 0.6").find("W137") != std::string::npos);  // 8 % at the bottom
    CHECK(ids_with(", max_speed: 0.1").find("E148") != std::string::npos);
  }
}
