#include <doctest/doctest.h>

#include <fmt/format.h>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// A step on the floor of a tank, beside its left wall.
template <int Dim>
std::string scene(const std::string& material) {
  return fmt::format(R"(
dimension: {}
resolution: 0.05
end_time: 1
materials: [{}]
bodies: [{{name: heap, material: filling, shape: {{type: box, min: [0.5, 0, 0], max: [1, 0.5,
    0.2]}}}}]
boundaries:
  - {{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.5, 0.6], open: [top]}}
  - {{name: step, type: wall, shape: {{type: box, min: [0, -0.2, 0], max: [0.5, 0.7, 0.3]}}}}
)",
                     Dim, material);
}

const char* const sand =
    "{name: filling, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 5e6, "
    "friction_angle: 30 deg}";

template <int Dim>
double corner_near(const ParticleSet<Dim>& walls, double x, double z, double y = 0.225) {
  const auto& r = walls.vector(fields::position);
  Index best = 0;
  const auto off = [&](Index i) {
    return std::hypot(r[i][0] - x, r[i][Dim - 1] - z) + (Dim == 3 ? std::abs(r[i][1] - y) : 0.0);
  };
  for (Index i = 1; i < walls.size(); ++i)
    if (off(i) < off(best)) best = i;
  CHECK(off(best) < 0.02);
  return walls.scalar(fields::corner)[best];
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE_TEMPLATE("wall particles behind two walls at once are marked", D,
                     std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
    constexpr int Dim = D::value;
    Rig<Dim> rig(scene<Dim>(sand));
    const auto& walls = rig.walls();
    CHECK(corner_near(walls, 1.025, -0.025) == 1);  // where floor and right wall meet
    CHECK(corner_near(walls, 1.075, -0.025) == 1);
    CHECK(corner_near(walls, 0.475, -0.025) == 1);  // under the foot of the step: two bodies
    CHECK(corner_near(walls, -0.025, 0.275) == 1);  // where the step's top meets the left wall
    CHECK(corner_near(walls, 0.725, -0.025) == 0);  // the floor in the open
    CHECK(corner_near(walls, 0.975, -0.075) == 0);  // the floor beside the corner
    CHECK(corner_near(walls, 1.025, 0.025) == 0);
    CHECK(corner_near(walls, 0.475, 0.275) == 0);  // the edge of the step
    if (Dim == 3) {
      CHECK(corner_near(walls, 1.025, 0.225, -0.025) == 1);   // an upright edge
      CHECK(corner_near(walls, 1.025, -0.025, -0.025) == 1);  // a corner of three walls
      CHECK(corner_near(walls, 0.725, 0.225, -0.025) == 0);
    }
  }

  TEST_CASE(
      "a plane of symmetry on a floor that goes on below it is no corner, however normals were "
      "turned there") {
    Rig<2> rig(fmt::format(R"(
dimension: 2
resolution: 0.05
end_time: 1
materials: [{}]
bodies: [{{name: heap, material: filling, shape: {{type: box, min: [0, 0, 0], max: [1, 0.5,
    0.2]}}}}]
boundaries:
  - {{name: symmetry, type: tank, min: [0, 0, 0], max: [2, 0.5, 0.6], open: [top, right, bottom],
      slip: free_slip}}
  - {{name: floor, type: tank, min: [-0.3, 0, 0], max: [2, 0.5, 0.6], open: [top, left, right]}}
)",
                           sand));
    const auto& walls = rig.walls();
    for (Index i = 0; i < walls.size(); ++i)
      if (walls.vector(fields::position)[i][1] > 0) CHECK(walls.scalar(fields::corner)[i] == 0);
    CHECK(corner_near(walls, -0.025, -0.025) == 1);
  }

  TEST_CASE("without soil no wall knows of corners") {
    Rig<2> rig(scene<2>("{name: filling, type: water}"));
    CHECK(!rig.walls().has(fields::corner));
  }
}
