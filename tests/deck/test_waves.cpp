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

  TEST_CASE(
      "the stroke: H / kd in shallow water (Galvin), H / 2 in deep water, Dean and Dalrymple's "
      "formula between") {
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

  TEST_CASE(
      "second order: grows with the square of the height, adds nothing in deep water, sharpens the "
      "push of long waves") {
    Waves w;
    w.height = 0.32;
    w.period = 2;
    w.depth = 0.7;
    CHECK(w.second_amplitude() == 0);
    const Vec3 first = w.displacement(12.1);
    w.order = 2;
    CHECK((w.displacement(12.1) - first).x() ==
          doctest::Approx(w.second_amplitude() * std::sin(4 * std::numbers::pi * 0.05)));
    const double high = w.second_amplitude();
    CHECK(high > 0);
    w.height = 0.16;
    CHECK(w.second_amplitude() == doctest::Approx(high / 4));
    // Long waves: the piston follows the water, dX/dt = c eta / (d + eta) (Goring). Of its second
    // harmonic H^2 / d (3 / (32 (kd)^3) belongs to Stokes' second crest; the rest is of the order
    // of 1 / kd.
    w.period = 60;
    const double kd = w.wave_number() * w.depth;
    CHECK(w.second_amplitude() ==
          doctest::Approx(3 * w.height * w.height / (32 * w.depth * kd * kd * kd))
              .epsilon(2 * kd * kd));
    // Deep water: what is left of it is -1/32 H^2 / d.
    w.period = 0.4;
    CHECK(w.second_amplitude() ==
          doctest::Approx(-w.height * w.height / (32 * w.depth)).epsilon(1e-3));
  }

  TEST_CASE("what stays near the piston holds what it displaces beyond what runs away") {
    Waves w;
    w.height = 0.05;
    w.period = 1.4;
    w.depth = 0.4;
    // Its volume is that displaced, d per metre of stroke, less what the progressive wave carries
    // past the piston.
    double volume = 0;
    const double step = 1e-4;
    for (int k = 0; k < 40000; ++k) volume += step * w.evanescent((k + 0.5) * step);
    CHECK(volume ==
          doctest::Approx(w.depth - w.height / (w.stroke() * w.wave_number())).epsilon(1e-3));
    CHECK(w.evanescent(3) == doctest::Approx(0).epsilon(1e-6));
  }

  TEST_CASE(
      "far from the piston a low wave is what was asked for; one of second order has a higher "
      "crest") {
    Waves w;
    w.height = 0.05;
    w.period = 1.4;
    w.depth = 0.4;
    const double length = 2 * std::numbers::pi / w.wave_number(), t = 10 * w.period;
    CHECK(w.elevation(4 * length, t) == doctest::Approx(0.025));
    CHECK(w.elevation(4.5 * length, t) == doctest::Approx(-0.025));
    CHECK(w.elevation(4 * length, 0) == 0);
    w.order = 2;
    CHECK(w.elevation(4 * length, t) > 0.026);
    // The range between crest and trough is the height in both.
    CHECK(w.elevation(4 * length, t) - w.elevation(4.5 * length, t) == doctest::Approx(0.05));
  }

  TEST_CASE("a piston takes up waves by sqrt(g / d) in shallow water, by omega / 2 in deep") {
    Waves w;
    w.height = 0.01;
    w.period = 30;
    w.depth = 1;
    CHECK(w.absorbing_rate() == doctest::Approx(std::sqrt(9.81)).epsilon(0.002));
    w.depth = 1e5;
    CHECK(w.absorbing_rate() == doctest::Approx(std::numbers::pi / 30));
  }
}
