// The key `around` of a body: it leaves the place of other bodies free.

#include <doctest/doctest.h>

#include "sample_types.h"

using namespace sphgeo;
using namespace sphgeo::sample;

namespace {

std::string sand_around(const std::string& names) {
  return R"(dimension: 2
resolution: 0.02
end_time: 1
materials: [{name: rock, type: rigid, density: 2000}]
bodies:
  - {name: sand, material: rock, around: )" +
         names + R"(, shape: {type: box, min: [0, 0, 0], max: [2, 0, 1]}}
  - {name: post, material: rock, shape: {type: box, min: [1.8, 0, 0], max: [1.9, 0, 2]}}
  - name: stone
    material: rock
    shape: {type: sphere, center: [0, 0, 0], radius: 0.1}
    copies: {count: 4, seed: 5, region: {type: box, min: [0.2, 0, 0.1], max: [1.6, 0, 0.9]}}
)";
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("around: a body leaves the place of others free, and of all copies by one name") {
    const Model m = read_deck_text(sand_around("[stone, post]"));
    REQUIRE(m.bodies.size() == 6);
    const Shape& sand = *m.bodies[0].shape;
    int inside = 0, free = 0;
    for (double x = 0.01; x < 2; x += 0.02)
      for (double z = 0.01; z < 1; z += 0.02) {
        const Vec3 p(x, 0, z);
        bool taken = false;
        for (std::size_t k = 1; k < 6; ++k)
          taken = taken || m.bodies[k].shape->signed_distance(p) < 0;
        CHECK((sand.bound(p) < 0) == !taken);
        ++(taken ? free : inside);
      }
    CHECK(free == doctest::Approx((4 * 3.14159 * 0.01 + 0.1) / 0.0004).epsilon(0.05));
    CHECK(inside + free == 5000);
    const std::string resolved = resolved_yaml(m);
    CHECK(resolved.find("around") == std::string::npos);
    CHECK(resolved_yaml(read_deck_text(resolved)) == resolved);
    CHECK(read_deck_text(sand_around("[stone_2]")).bodies[0].shape->bound(Vec3(1.85, 0, 0.5)) < 0);
  }

  TEST_CASE("around: names that are no other body are told, with the nearest") {
    const auto says = [](const std::string& names) {
      const auto found = findings(sand_around(names));
      REQUIRE(found.size() == 1);
      CHECK(found[0].path == "bodies[0].around");
      CHECK(found[0].place.line == 6);
      return found[0].message + "; " + found[0].help;
    };
    CHECK(says("[stonne]").find("did you mean 'stone'?") != std::string::npos);
    CHECK(says("[post, pst]").find("did you mean 'post'?") != std::string::npos);
    CHECK(says("[sand]").find("there is no other body") != std::string::npos);
    CHECK(says("stone").find("write around: [") != std::string::npos);
    CHECK(says("[[post]]").find("there is no other body") != std::string::npos);
  }
}
