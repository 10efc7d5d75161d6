// The key `copies` of a body: many bodies from one.

#include <doctest/doctest.h>

#include <cmath>

#include "sample_types.h"

using namespace sphgeo;
using namespace sphgeo::sample;

namespace {

std::string rocks(
    int dimension, const std::string& copies,
    const std::string& shape = "{type: boulder, center: [1, 0, 1], radius: r, seed: 7}") {
  return "dimension: " + std::to_string(dimension) + R"(
resolution: 0.02
end_time: 1
variables: {r: 0.1}
materials: [{name: rock, type: rigid, density: 2000}]
bodies:
  - {name: one, material: rock, shape: {type: sphere, center: [9, 0, 0], radius: 0.1}}
  - name: stone
    material: rock
    shape: )" +
         shape + "\n    copies: " + copies + "\n";
}

const std::string twelve =
    "{count: 12, seed: 3, sizes: [0.5, 1.5], gap: 0.05, region: {type: box, min: [-1, -1, 0], max: "
    "[1, 1, 2]}}";

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE(
      "copies: bodies of their own names, inside of the region, apart, and of several sizes") {
    for (const int dimension : {2, 3}) {
      const Model m = read_deck_text(rocks(dimension, twelve));
      REQUIRE(m.bodies.size() == 13);
      CHECK(m.bodies[0].name == "one");
      CHECK(m.bodies[1].name == "stone_1");
      CHECK(m.bodies[12].name == "stone_12");
      // Points of each: inside of the region, and none within the gap of another body.
      for (std::size_t a = 1; a < 13; ++a) {
        const Aabb box = m.bodies[a].shape->box();
        int inside = 0;
        for (double x = box.lo.x(); x <= box.hi.x(); x += 0.02)
          for (double z = box.lo.z(); z <= box.hi.z(); z += 0.02) {
            const Vec3 p(x, 0.5 * (box.lo.y() + box.hi.y()), z);
            if (m.bodies[a].shape->signed_distance(p) > 0) continue;
            ++inside;
            CHECK(std::abs(x) <= 1);
            CHECK(std::abs(z - 1) <= 1);
            for (std::size_t b = 1; b < 13; ++b)
              if (b != a) CHECK(m.bodies[b].shape->signed_distance(p) > 0.03);
          }
        CHECK(inside > 4);
      }
      const auto width = [&](std::size_t k) {
        return m.bodies[k].shape->box().hi.x() - m.bodies[k].shape->box().lo.x();
      };
      CHECK(width(1) > 1.5 * width(12));  // the largest come first
      // The resolved deck holds them one by one, and means the same.
      const std::string resolved = resolved_yaml(m);
      CHECK(resolved.find("copies") == std::string::npos);
      CHECK(resolved_yaml(read_deck_text(resolved)) == resolved);
      CHECK(deck_hash(m) == deck_hash(read_deck_text(rocks(dimension, twelve))));
      CHECK(deck_hash(m) !=
            deck_hash(read_deck_text(rocks(dimension, twelve), {"bodies.stone.copies.seed=4"})));
      CHECK(
          read_deck_text(rocks(dimension, twelve), {"bodies.stone.copies.count=3"}).bodies.size() ==
          4);
    }
  }

  TEST_CASE("copies that do not fit, and other mistakes, are told with their place") {
    const auto says = [](const std::string& copies, const std::string& what,
                         const std::string& shape =
                             "{type: sphere, center: [0, 0, 0], radius: r}") {
      CAPTURE(copies);
      const auto found = findings(rocks(2, copies, shape));
      REQUIRE(found.size() == 1);
      CHECK(found[0].message.find(what) != std::string::npos);
      CHECK(found[0].place.line >= 10);
      return found[0];
    };
    const Diagnostic full =
        says("{count: 500, region: {type: box, min: [-1, 0, 0], max: [1, 0, 2]}}",
             "of 500 copies fit into the region");
    CHECK(full.place.line == 11);
    CHECK(full.place.column == 5);
    says("{count: 2, region: {type: half_space, point: [0, 0, 1]}}", "unbounded");
    says("{count: 2, region: {type: box, min: [-1, 0, 0], max: [1, 0, 2]}, sizes: [2, 1]}",
         "larger than the largest");
    says("{count: 0, region: {type: box, min: [-1, 0, 0], max: [1, 0, 2]}}", "0");
    const auto misspelt = findings(
        "dimension: 2\nresolution: 0.1\nend_time: 1\nmaterials: [{name: w, type: water, "
        "sound_speed: 10}]\n"
        "bodies: [{name: b, material: w, shape: {type: sphere, center: [0, 0, 0], radius: 1}, "
        "copys: {}}]\n");
    REQUIRE(misspelt.size() == 1);
    CHECK(misspelt[0].help == "did you mean 'copies'?");
    says("{cuont: 2, region: {type: box, min: [-1, 0, 0], max: [1, 0, 2]}}", "cuont");
    says("{count: 2, region: {type: box, min: [-1, 0, 0], max: [1, 0, 2]}}", "radios",
         "{type: sphere, center: [0, 0, 0], radios: r}");
  }
}
