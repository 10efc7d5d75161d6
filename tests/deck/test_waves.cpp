#include "deck/waves.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace sphgeo;

TEST_SUITE("deck") {
  TEST_CASE("the wave number meets the dispersion relation from shallow to deep water") {
    for (const double depth : {0.01, 0.2, 1.0, 20.0, 4000.0})
      for (const double period : {0.5, 2.0, 15.0}) {
        Waves w;
        w.period = period;
        w.depth = depth;
        const double k = w.wave_number(), omega = 2 * std::numbers::pi / period;
        CHECK(9.81 * k * std::tanh(k * depth) == doctest::Approx(omega * omega).epsilon(1e-12));
      }
  }

  TEST_CASE("the stroke: H / kd in shallow water (Galvin), H / 2 in deep water, Dean and Dalrymple's formula between") {
    Waves w;
    w.height = 0.1;
    w.period = 30;
    w.depth = 1;
    CHECK(w.stroke() == doctest::Approx(0.1 / w.wave_number()).epsilon(0.002));
    w.depth = 1e5;
    CHECK(w.stroke() == doctest::Approx(0.05));
    w.depth = 1;
    w.period = 2;
    const double x = 2 * w.wave_number();
    CHECK(w.stroke() == doctest::Approx(0.1 * (std::sinh(x) + x) / (2 * (std::cosh(x) - 1))));
  }

  TEST_CASE("the piston starts from rest, and swings by half its stroke to both sides") {
    Waves w;
    w.height = 0.05;
    w.period = 1;
    w.depth = 0.4;
    CHECK(w.displacement(-1).norm() == 0);
    CHECK(w.displacement(1e-4).norm() < 1e-9);
    CHECK(w.displacement(10.25).x() == doctest::Approx(0.5 * w.stroke()));
    CHECK(w.displacement(10.75).x() == doctest::Approx(-0.5 * w.stroke()));
  }
}
