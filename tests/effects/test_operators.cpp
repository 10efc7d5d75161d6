// The operators on fields with a known answer, and the balance of still water.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

constexpr const char* no_arranging =
    "numerics: {transport_velocity: false, density_reinitialization: none, pair_precision: "
    "double}\n";

std::string moving_block(int dimension, const std::string& velocity) {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials: [{{name: water, type: water, sound_speed: 200}}]
bodies:
  - name: block
    material: water
    shape: {{type: box, min: [0, 0, 0], max: [1.2, 1.2, 1.2]}}
    velocity: {}
{})",
                     dimension, velocity, no_arranging);
}

// -(d rho/dt) / rho of the particles whose kernel is full: smallest and largest.
template <int Dim>
std::pair<double, double> divergence(const std::string& velocity) {
  Rig<Dim> rig(moving_block(Dim, velocity));
  rig.plan_it();
  rig.freeze();
  rig.plan->run(Stage::rate);
  double low = 1e9, high = -1e9;
  for (Index i = 0; i < rig.water().size(); ++i) {
    if (test::depth_in_box<Dim>(rig.water().vector(fields::position)[i], Vec<Dim>::Zero(),
                                Vec<Dim>::Constant(1.2)) < 0.36)
      continue;
    const double d =
        -rig.water().scalar(fields::density_rate)[i] / rig.water().scalar(fields::density)[i];
    low = std::min(low, d);
    high = std::max(high, d);
  }
  return {low, high};
}

// Still water with exact hydrostatic density: |dv/dt| / g at the places that matter.
struct Balance {
  double interior = 0, side = 0, floor = 0, corner = 0, surface = 0;
};

Balance still_balance(const std::string& slip) {
  Rig<2> rig(fmt::format(R"(
dimension: 2
resolution: 0.02
gravity: 9.81
end_time: 1
materials: [{{name: water, type: water, viscosity: 1e-3}}]
bodies:
  - {{name: pool, material: water, shape: {{type: box, min: [0, 0, 0], max: [0.6, 0.1, 0.5]}},
      pressure: hydrostatic}}
boundaries:
  - {{name: tank, type: tank, min: [0, 0, 0], max: [0.6, 0.1, 0.6], open: [top], slip: {}}}
{})",
                         slip, no_arranging));
  rig.plan_it();
  rig.freeze();
  rig.plan->run(Stage::force);
  const double reach = 0.072;
  Balance b;
  for (Index i = 0; i < rig.water().size(); ++i) {
    const Vec<2> x = rig.water().vector(fields::position)[i];
    const double a = rig.water().vector(fields::acceleration_sum)[i].norm() / 9.81;
    const bool side = x[0] < reach || x[0] > 0.6 - reach,
               floor = x[1]<reach, surface = x[1]> 0.5 - reach;
    double& place = surface         ? b.surface
                    : side && floor ? b.corner
                    : side          ? b.side
                    : floor         ? b.floor
                                    : b.interior;
    place = std::max(place, a);
  }
  return b;
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("the divergence of linear fields is exact to a few per cent, of a rotation zero") {
    const auto check = [](auto found, double expected) {
      INFO("divergence ", expected, ": ", found.first, " to ", found.second);
      CHECK(found.first == doctest::Approx(expected).epsilon(0.02));
      CHECK(found.second == doctest::Approx(expected).epsilon(0.02));
    };
    check(divergence<2>("[x, 0, 0]"), 1);
    check(divergence<2>("[2*x - z, 0, x - 0.5*z]"), 1.5);
    check(divergence<3>("[x, -3*y + z, 4*z - x]"), 2);
    for (const auto& [low, high] :
         {divergence<2>("[z - 0.3, 0, -x]"), divergence<3>("[z - y, x, -x]")}) {
      CHECK(std::abs(low) < 1e-12);
      CHECK(std::abs(high) < 1e-12);
    }
    // Shear without divergence.
    CHECK(std::abs(divergence<2>("[5*z, 0, 0]").second) < 1e-12);
  }

  TEST_CASE("still water with exact hydrostatic density is nearly in balance, also at the walls") {
    for (const char* slip : {"no_slip", "free_slip"}) {
      const Balance b = still_balance(slip);
      INFO("|a|/g of still water, ", std::string(slip), ": interior ", b.interior, ", side wall ",
           b.side, ", floor ", b.floor, ", corner ", b.corner, ", surface ", b.surface);
      // Twice what was measured: 0.013, 0.032, 0.037, 0.039 and, where the kernel is cut, 0.13.
      CHECK(b.interior < 0.026);
      CHECK(b.side < 0.065);
      CHECK(b.floor < 0.075);
      CHECK(b.corner < 0.08);
      CHECK(b.surface < 0.27);
    }
  }
}
