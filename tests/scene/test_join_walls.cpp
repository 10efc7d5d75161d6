#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

/// A step that stands on the floor of a tank, and reaches into its left wall.
template <int Dim>
std::string scene(const std::string& step_motion = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.05
end_time: 1
materials: [{{name: water, type: water}}]
bodies: [{{name: pool, material: water, shape: {{type: box, min: [0.5, 0, 0], max: [1, 0.2,
    0.2]}}}}]
boundaries:
  - {{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.2, 0.6], open: [top]}}
  - {{name: step, type: wall, shape: {{type: box, min: [-0.1, -0.2, 0], max: [0.5, 0.4, 0.3]}}{}}}
)",
                     Dim, step_motion);
}

template <int Dim>
Vec<Dim> normal_near(const ParticleSet<Dim>& walls, double x, double z) {
  const auto& r = walls.vector(fields::position);
  Index best = 0;
  const auto off = [&](Index i) {
    return std::hypot(r[i][0] - x, r[i][Dim - 1] - z) + (Dim == 3 ? std::abs(r[i][1] - 0.1) : 0.0);
  };
  for (Index i = 1; i < walls.size(); ++i)
    if (off(i) < off(best)) best = i;
  return walls.vector(fields::normal)[best];
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE_TEMPLATE("walls that overlap are filled once", D, std::integral_constant<int, 2>,
                     std::integral_constant<int, 3>) {
    constexpr int Dim = D::value;
    Rig<Dim> rig(scene<Dim>());
    const auto& r = rig.walls().vector(fields::position);
    Index close = 0;
    for (Index i = 0; i < rig.walls().size(); ++i)
      for (Index j = 0; j < i; ++j) close += (r[i] - r[j]).norm() < 0.45 * 0.05 ? 1 : 0;
    CHECK(close == 0);
    // The left wall of the tank keeps its particles below the top of the step.
    const auto& part = rig.walls().tag(fields::part);
    Index tank_there = 0, step_there = 0;
    for (Index i = 0; i < rig.walls().size(); ++i)
      if (r[i][0] < 0 && r[i][Dim - 1] > 0 && r[i][Dim - 1] < 0.3)
        ++(part[i] == 0 ? tank_there : step_there);
    CHECK(tank_there > 10);
    CHECK(step_there == 0);
  }

  TEST_CASE_TEMPLATE("normals at the foot of a step point to the water", D,
                     std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
    constexpr int Dim = D::value;
    Rig<Dim> rig(scene<Dim>());
    const ParticleSet<Dim>& walls = rig.walls();
    const Vec<Dim> right = Vec<Dim>::Unit(0), up = Vec<Dim>::Unit(Dim - 1);
    CHECK(normal_near(walls, 0.475, 0.025).dot(right) > 0.9);  // the step, beside its lower face
    CHECK(normal_near(walls, 0.425, 0.225).dot(right) > 0.6);
    CHECK(normal_near(walls, 0.525, -0.025).dot(up) > 0.99);   // the floor in the open
    const Vec<Dim> under = normal_near(walls, 0.475, -0.025);  // the floor under the step
    CHECK(under.dot(right) > 0.5);
    CHECK(under.dot(up) > 0.1);
    CHECK(normal_near(walls, 0.025, 0.275).dot(up) >
          0.9);  // the step's top beside the wall that it enters
    CHECK(normal_near(walls, -0.025, 0.325).dot(right) > 0.99);  // the wall above the step
  }

  TEST_CASE(
      "where two walls touch along a line, their edges face the soil in the corner that can hold "
      "it") {
    // A table beside a floor that ends where the table begins: the corner under the table is as
    // near.
    Rig<2> rig(R"(
dimension: 2
resolution: 0.05
end_time: 1
materials: [{name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 5e6,
    friction_angle: 30 deg}]
bodies: [{name: heap, material: sand, shape: {type: box, min: [0.5, 0, 0], max: [1, 0.5, 0.2]}}]
boundaries:
  - {name: table, type: wall, shape: {type: box, min: [-0.5, -0.1, 0], max: [0.5, 0.6, 0.3]}}
  - {name: floor, type: wall, shape: {type: box, min: [0.5, -0.1, -0.5], max: [1.5, 0.6, 0]}}
)");
    const Vec<2> table = normal_near(rig.walls(), 0.475, 0.025),
                 floor = normal_near(rig.walls(), 0.525, -0.025);
    CHECK(table.minCoeff() > 0.3);
    CHECK(floor.minCoeff() > 0.3);
  }

  TEST_CASE("boundaries that move are left as they are") {
    Rig<2> joined(scene<2>()), moved(scene<2>(", motion: {displacement: [0, 0, t]}"));
    CHECK(moved.walls().size() > joined.walls().size());
    CHECK(normal_near(moved.walls(), 0.425, 0.025)[1] == doctest::Approx(-1));
  }
}
