#include "scene/body_filling.h"

#include "scene/cross_check.h"
#include "support/rig.h"

using namespace sphgeo;

namespace {

FillingChoice choice_of(const std::string& shape, const std::string& material = "stone",
                        const std::string& more = "", int dimension = 2) {
  const Model model = read_deck_text(
      "dimension: " + std::to_string(dimension) +
      "\nresolution: 0.05\nend_time: 1\nmaterials:\n"
      "  - {name: stone, type: rigid, density: 2500}\n"
      "  - {name: rubber, type: elastic, density: 1000, youngs_modulus: 1e6, poisson_ratio: 0.3}\n"
      "  - {name: water, type: water, max_speed: 5}\n" +
      more + "bodies:\n  - {name: it, material: " + material + ", shape: " + shape + "}\n");
  return filling_of(model.bodies[0], model);
}

const std::string box = "{type: box, min: [0, 0, 0], max: [1, 1, 0.5]}",
                  ball = "{type: sphere, center: [0, 0, 0], radius: 0.5}";

std::string turned(const std::string& angle) {
  return "{type: transform, rotate: " + angle + ", of: " + box + "}";
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE(
      "rigid solids with faces that are not along the axes are relaxed, all else on a lattice") {
    for (const std::string& shape :
         {ball, turned("30 deg"),
          std::string("{type: polygon, points: [[0, 0, 0], [1, 0, 0], [0.5, 0, 1]], y_min: 0, "
                      "y_max: 1}"),
          "{type: difference, of: [" + box + ", " + ball + "]}"}) {
      CHECK(choice_of(shape).relaxed);
      CHECK_FALSE(choice_of(shape, "rubber").relaxed);
      CHECK_FALSE(choice_of(shape, "water").relaxed);
    }
    for (const std::string& shape :
         {box, turned("90 deg"),
          std::string("{type: polygon, points: [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], "
                      "y_min: 0, y_max: 1}"),
          "{type: union, of: [" + box + ", {type: box, min: [0, 0, 0.5], max: [0.2, 1, 1]}]}"})
      CHECK_FALSE(choice_of(shape).relaxed);
    CHECK(choice_of(ball, "stone", "", 3).relaxed);
    CHECK(choice_of(ball, "stone", "numerics: {solid_gradient: quadratic}\n").relaxed);
  }

  TEST_CASE("an elastic solid with an acute corner stays at rest without a load") {
    test::Rig<2> rig(
        "dimension: 2\nresolution: 0.02\nend_time: 1\ngravity: 0\n"
        "materials: [{name: rubber, type: elastic, density: 1100, youngs_modulus: 1e6}]\n"
        "bodies: [{name: b, material: rubber, shape: {type: polygon, points: [[0, 0, 0.1], [0.2, "
        "0, "
        "0.1], [0.2, 0, 0.2]]}}]\n");
    rig.plan_it();
    rig.stepper->run(0.1, {[] { return true; }});
    const auto& v = rig.world.set("solids").vector(fields::velocity);
    for (Index i = 0; i < v.size(); ++i) CHECK(v[i].norm() < 1e-9);
  }

  TEST_CASE("what no lattice and no relaxation can fill is an error at the shape, of every phase") {
    for (const std::string material : {"stone", "sand", "water"})
      for (const auto& [shape, id] :
           {std::pair<std::string, std::string>{"{type: half_space, point: [0, 0, 0]}", "E113"},
            {"{type: box, min: [0, 0, 0], max: [0.01, 1, 0.01]}", "E110"}}) {
        CAPTURE(material);
        const Model model = read_deck_text(
            "dimension: 2\nresolution: 0.05\nend_time: 1\nmaterials:\n"
            "  - {name: stone, type: rigid, density: 2500}\n"
            "  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: "
            "1e6, friction_angle: 30 deg}\n"
            "  - {name: water, type: water, max_speed: 5}\n"
            "bodies:\n  - {name: it, material: " +
            material + ", shape: " + shape + "}\n");
        Diagnostics found;
        build_scene<2>(model, found);
        REQUIRE(found.items().size() == 1);
        CHECK(found.items()[0].id == id);
        CHECK(found.items()[0].path == "bodies[0].shape");
        CHECK(found.items()[0].place.line == 9);
      }
  }

  TEST_CASE("a skeleton without a stiffness stores no energy") {
    test::Rig<2> rig(
        "dimension: 2\nresolution: 0.05\nend_time: 1\nmaterials:\n"
        "  - {name: plug, type: soil, density: 2600, volume_fraction: 0.6, skeleton: fixed, "
        "grain_size: 5 mm}\n"
        "  - {name: water, type: water, max_speed: 5}\n"
        "bodies:\n"
        "  - {name: bed, material: plug, shape: {type: box, min: [0, 0, 0], max: [0.5, 1, 0.2]}}\n"
        "  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0.2], max: [0.5, 1, "
        "0.4]}}\n"
        "probes: [{name: e, type: energy, set: soil}]\n");
    rig.plan_it();
    rig.advance(2);
    const auto row = rig.sample(0);
    CHECK(row.at(2) == 0);                    // internal
    CHECK(std::isfinite(row.at(1).value()));  // potential
  }

  TEST_CASE("a skeleton that does not deform needs a stiffness only beside solids and alone") {
    const auto ids = [](const std::string& bodies) {
      const Model model = read_deck_text(
          "dimension: 2\nresolution: 0.05\nend_time: 1\nmaterials:\n"
          "  - {name: plug, type: soil, density: 2600, volume_fraction: 0.6, skeleton: fixed, "
          "grain_size: 5 mm}\n"
          "  - {name: stone, type: rigid, density: 2500}\n"
          "  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e6, "
          "friction_angle: 30 deg}\n"
          "  - {name: water, type: water, max_speed: 5}\n"
          "bodies:\n  - {name: bed, material: plug, shape: {type: box, min: [0, 0, 0], max: [1, "
          "1, 0.5]}}\n" +
          bodies);
      Diagnostics found;
      const Scene<2> scene = build_scene<2>(model, found);
      check_scene(scene, found);
      std::string text;
      for (const Diagnostic& d : found.items()) text += d.id + " ";
      return text;
    };
    const std::string above = ", shape: {type: box, min: [0, 0, 0.5], max: [1, 1, 0.7]}}\n";
    CHECK(ids("  - {name: pool, material: water" + above) == "");
    CHECK(ids("  - {name: block, material: stone" + above) == "E154 ");
    CHECK(ids("  - {name: bank, material: sand" + above) == "E154 ");
    CHECK(ids("") == "E154 ");
  }
}
