#include <doctest/doctest.h>

#include <fmt/format.h>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// A block on a floor, a second one beside it; all on one lattice.
std::string blocks(int dimension, double lift, double aside) {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials: [{{name: rock, type: rigid, density: 2000}}]
bodies:
  - {{name: block, material: rock, shape: {{type: box, min: [0, 0, {}], max: [1, 1, {}]}}}}
  - {{name: other, material: rock, shape: {{type: box, min: [{}, 0, 2], max: [{}, 1, 3]}}}}
  - {{name: far, material: rock, shape: {{type: box, min: [5, 0, 2], max: [6, 1, 3]}}}}
boundaries:
  - {{name: floor, type: wall, shape: {{type: box, min: [-1, -1, -0.4], max: [3, 2, 0]}}}}
probes:
  - {{name: of_block, type: penetration, body: block}}
  - {{name: of_far, type: penetration, body: far}}
  - {{name: of_all, type: penetration}}
)",
                     dimension, lift, lift + 1, aside, aside + 1);
}

// What the probe says of the block that is moved as a whole, to (dx, dz) from its place.
template <int Dim>
double depth(double dx, double dz, double turn = 0) {
  Rig<Dim> rig(blocks(Dim, 1, 3));
  const auto move = [&](const std::string& set) {
    auto& s = rig.world.set(set);
    auto& x = s.vector(fields::position);
    for (Index i = 0; i < s.size(); ++i) {
      if (s.tag(fields::part)[i] != 0) continue;
      const double a = x[i][0] - 0.5, b = x[i][Dim - 1] - 1.5;
      x[i][0] = 0.5 + dx + std::cos(turn) * a - std::sin(turn) * b;
      x[i][Dim - 1] = 1.5 + dz + std::sin(turn) * a + std::cos(turn) * b;
    }
  };
  move("solids");
  move("interface");
  rig.plan_it();
  CHECK(*rig.sample(1)[0] == 0);
  CHECK(*rig.sample(2)[0] == doctest::Approx(*rig.sample(0)[0]).epsilon(1e-12));
  CHECK(*rig.sample(0)[1] == doctest::Approx(*rig.sample(0)[0] / 0.1).epsilon(1e-12));
  return *rig.sample(0)[0];
}

template <int Dim>
void check_depths() {
  CHECK(depth<Dim>(0, 0) == 0);
  CHECK(depth<Dim>(0, -0.95) == 0);
  CHECK(depth<Dim>(0, -1) < 1e-9);  // it stands on the floor
  CHECK(depth<Dim>(0, -1.03) == doctest::Approx(0.03).epsilon(1e-6));
  CHECK(depth<Dim>(0.05, -1.03) ==
        doctest::Approx(0.03).epsilon(1e-6));  // between the rows of the floor
  CHECK(depth<Dim>(0.05, -1.15) == doctest::Approx(0.15).epsilon(1e-6));
  CHECK(depth<Dim>(2.04, 1) ==
        doctest::Approx(0.04).epsilon(
            0.15));  // side into side, with edges flush: the normals are oblique there
  CHECK(depth<Dim>(1.9, 1.05) == 0);
  // On its edge, which is half a spacing of its diagonal inside of what a ball of a spacing's width
  // takes up.
  const double turned =
      depth<Dim>(0.013, -1.5 + 0.5 * std::sqrt(2.0) - 0.03, 0.25 * 3.14159265358979);
  CHECK(turned > 0.0);
  CHECK(turned < 0.06);
}

}  // namespace

TEST_SUITE("probes") {
  TEST_CASE("penetration: how deep a block lies in a floor and in another block") {
    check_depths<2>();
    check_depths<3>();
  }
}
