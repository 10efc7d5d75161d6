// The pair of a water and a wall particle by itself: signs and closed forms of Eqs. 73 and 74.

#include "effects/wall_pair.h"

#include <doctest/doctest.h>

using namespace sphgeo;

namespace {

constexpr double rho = 1000, g = 9.81, dp = 0.1, h = 1.8 * dp, volume = dp * dp;
const WaterParameters constants{rho, 30.0, 2.0, 3.0};
const WallPair<2> pair(constants, h, dp);
// The wall's pressure gradient: rho g over the kernel's lattice moment, see WallPair.
const double gradient = rho * g * pair.slope;
using Wall = WallRecord<2, double>;
using Water = Record<double, packed::WaterState<2>, packed::PressureGradient<2>>;
using V = LaneVec<2, double>;

auto state(Wall& w) { return PackedRecord<packed::Wall<2>, double>(w.slot); }
auto surface(Wall& w) { return PackedRecord<packed::WallSurface<2>, double>(w.slot + record_size); }
auto state(Water& w) { return PackedRecord<packed::WaterState<2>, double>(w.slot); }
auto gradient_of(Water& w) {
  return PackedRecord<packed::PressureGradient<2>, double>(w.slot + record_size);
}

// A particle of a floor at rest, normal up.
Wall floor_particle() {
  Wall w{};
  state(w).put(packed::Wall<2>::volume, volume);
  state(w).put(packed::Wall<2>::no_slip, 1);
  surface(w).put(packed::WallSurface<2>::normal, 1, 1);
  surface(w).put(packed::WallSurface<2>::push, g);
  surface(w).put(packed::WallSurface<2>::weight, g);
  return w;
}

// Water at rest with pressure p.
Water still_water(double p) {
  Water w{};
  state(w).put(packed::WaterState<2>::volume, volume);
  state(w).put(packed::WaterState<2>::pressure, p);
  gradient_of(w).put(packed::PressureGradient<2>::over_density, 1, -g);
  gradient_of(w).put(packed::PressureGradient<2>::density, rho);
  return w;
}

V at(double x, double z) {
  V r;
  r[0] = x;
  r[1] = z;
  return r;
}

double slope(const V& r) { return Kernel<2>(h).dw_over_r(dot(r, r)); }

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE(
      "under still water the floor's pressure exceeds the water's by rho g times their distance") {
    const V r = at(0, dp);
    CHECK(rho * WallPair<2>::rise(floor_particle(), r[1]) == doctest::Approx(rho * g * dp));
    CHECK(gradient == doctest::Approx(rho * g).epsilon(0.01));
    // -(p_i + p_wall) grad W V_wall, with p_wall = p_i + rho g z.
    const V f = pair.force(still_water(500), floor_particle(), r, dot(r, r));
    CHECK(f[0] == 0.0);
    CHECK(f[1] == doctest::Approx(-(2 * 500 + gradient * dp) * slope(r) * dp * volume));
    CHECK(f[1] > 0);
  }

  TEST_CASE("beside the pair's normal the wall's pressure follows the height only") {
    for (const double x : {-0.2, -0.05, 0.15}) {
      const V r = at(x, 0.5 * dp);
      const V f = pair.force(still_water(500), floor_particle(), r, dot(r, r));
      CHECK(f[1] ==
            doctest::Approx(-(2 * 500 + gradient * 0.5 * dp) * slope(r) * 0.5 * dp * volume));
    }
  }

  TEST_CASE("at a side wall the wall's pressure is hydrostatic at rest, constant in free fall") {
    Wall side = floor_particle();
    surface(side).put(packed::WallSurface<2>::normal, 0, 1);
    surface(side).put(packed::WallSurface<2>::normal, 1, 0);
    surface(side).put(packed::WallSurface<2>::push, 0);
    surface(side).put(packed::WallSurface<2>::weight, 0);
    const V r = at(dp, dp);  // the wall particle lies lower by dp
    const V rest = pair.force(still_water(500), side, r, dot(r, r));
    CHECK(rest[0] == doctest::Approx(-(2 * 500 + gradient * dp) * slope(r) * dp * volume));
    Water falling = still_water(500);
    gradient_of(falling).put(packed::PressureGradient<2>::over_density, 1, 0);
    const V fall = pair.force(falling, side, r, dot(r, r));
    CHECK(fall[0] == doctest::Approx(-2 * 500 * slope(r) * dp * volume));
  }

  TEST_CASE(
      "water that runs into a wall is pushed back by the Riemann term, water that leaves is not") {
    const V r = at(0, dp);
    const auto force_at = [&](double speed) {
      Water w = still_water(500);
      state(w).put(packed::WaterState<2>::velocity, 1, speed);
      const WallPair<2> inviscid({rho, 30.0, 0.0, 3.0}, h, dp);
      return inviscid.force(w, floor_particle(), r, dot(r, r))[1];
    };
    const double rest = force_at(0);
    CHECK(force_at(1) == doctest::Approx(rest));
    // Closing speed 2, beta = min(3 * 2 / 30, 1), times rho c (Eq. 73).
    CHECK(force_at(-1) - rest == doctest::Approx(-0.2 * rho * 30 * 2 * slope(r) * dp * volume));
    // Saturated limiter.
    CHECK(force_at(-8) - rest == doctest::Approx(-1.0 * rho * 30 * 16 * slope(r) * dp * volume));
  }

  TEST_CASE("friction acts against the motion along the wall, and only with no slip") {
    const V r = at(0, dp);
    Water w = still_water(0);
    gradient_of(w).put(packed::PressureGradient<2>::over_density, 1, 0);
    state(w).put(packed::WaterState<2>::velocity, 0, 3);
    Wall wall = floor_particle();
    surface(wall).put(packed::WallSurface<2>::push, 0);
    const V stuck = pair.force(w, wall, r, dot(r, r));
    // Eq. 74 with v_i - v_wall^d = 2 (v_i - v_wall).
    CHECK(stuck[0] == doctest::Approx(2 * 2.0 * 2 * 3 * slope(r) * dp * dp /
                                      (dp * dp + 0.01 * h * h) * volume));
    CHECK(stuck[0] < 0);
    state(wall).put(packed::Wall<2>::no_slip, 0);
    CHECK(pair.force(w, wall, r, dot(r, r))[0] == 0.0);
    // A wall that moves along with the water does not rub.
    state(wall).put(packed::Wall<2>::no_slip, 1);
    state(wall).put(packed::Wall<2>::velocity, 0, 3);
    CHECK(pair.force(w, wall, r, dot(r, r))[0] == 0.0);
  }

  TEST_CASE(
      "a wall that moves into the water compresses it, one that leads gravity away does not "
      "dissipate") {
    Record<double, packed::WaterState<2>> water{};
    const V r = at(0, dp);
    Wall wall = floor_particle();
    CHECK(pair.divergence(water, wall, r, dot(r, r)) == doctest::Approx(0));
    state(wall).put(packed::Wall<2>::velocity, 1, 1);
    // d rho/dt = rho * sum of 2 (v_i - v_wall) . grad W V, positive when they close.
    CHECK(pair.divergence(water, wall, r, dot(r, r)) ==
          doctest::Approx(-2 * slope(r) * dp * volume));
    CHECK(pair.divergence(water, wall, r, dot(r, r)) > 0);
  }
}
