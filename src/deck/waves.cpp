#include "deck/waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/direction.h"

namespace sphgeo {

Schema<Waves> Waves::schema() {
  Schema<Waves> s("waves", "Regular waves by a piston, given by height, period and depth.");
  s.required("height", &Waves::height, unit::length, "wave height, from trough to crest").above(0);
  s.required("period", &Waves::period, unit::time, "wave period").above(0);
  s.required("depth", &Waves::depth, unit::length, "still-water depth").above(0);
  s.optional("gravity", &Waves::gravity, unit::acceleration, "gravity of the wave theory").above(0);
  s.optional("direction", &Waves::direction, unit::none,
             "direction of wave propagation, of any length");
  s.optional("order", &Waves::order, unit::none,
             "order of the wave maker theory: 1 linear; 2 second order, for waves of finite height "
             "(Madsen 1971)")
      .at_least(1)
      .at_most(2);
  s.optional("ramp", &Waves::ramp, unit::time,
             "duration of the ramp of the stroke; auto: two periods")
      .at_least(0);
  s.optional("absorb", &Waves::absorb, unit::none,
             "active wave absorption: the piston absorbs reflected waves, from the water level in "
             "front of it");
  s.check([](Waves& w, CheckContext& c) {
    w.direction = direction_of(w.direction);
    if (w.direction.isZero(0))
      return c.error("direction", "the direction has no length", "give a vector that is not zero");
    if (w.absorb && std::abs(w.direction.z()) > 1e-9)
      c.error("direction", "active wave absorption needs a horizontal direction of propagation",
              "a direction without z");
    if (w.height >= 0.78 * w.depth)
      c.error("height",
              fmt::format("waves break before they are as high as 0.78 of the depth, here {:.4g} m",
                          0.78 * w.depth),
              "a lower wave, or deeper water");
    const double steepness = w.height * w.wave_number() / (2 * std::numbers::pi);
    if (steepness >= 0.142 * std::tanh(w.wave_number() * w.depth))
      c.error("height",
              fmt::format("waves of this period break when they are steeper than 0.142 tanh(kd); "
                          "this one is {:.3g}",
                          steepness),
              "a lower or a longer wave");
    // Above this bound the second-order wave has a secondary crest in its trough.
    const double length = 2 * std::numbers::pi / w.wave_number(),
                 ursell = w.height * length * length / std::pow(w.depth, 3);
    const double highest = 8 * std::numbers::pi * std::numbers::pi / 3;
    if (w.order == 2 && ursell >= highest)
      c.error("order",
              fmt::format("H L^2 / d^3 is {:.3g}; the theory of second order holds below {:.3g}",
                          ursell, highest),
              "order: 1, a lower or a shorter wave, or deeper water");
  });
  return s;
}

double Waves::omega() const { return 2 * std::numbers::pi / period; }

double Waves::wave_number() const {
  const double deep = omega() * omega() * depth / gravity;
  // x tanh x = deep: Newton's method from Eckart's approximation, which converges for any depth.
  double x = deep / std::sqrt(std::tanh(deep));
  for (int k = 0; k < 50; ++k) {
    const double t = std::tanh(x), next = x - (x * t - deep) / (t + x * (1 - t * t));
    if (std::abs(next - x) <= 1e-14 * x) break;
    x = next;
  }
  return x / depth;
}

double Waves::stroke() const {
  const double x = 2 * wave_number() * depth;
  // Both sides by exp(x): they overflow in deep water.
  const double e = std::exp(-x), e2 = e * e;
  return height * ((1 - e2) / 2 + x * e) / (2 * ((1 + e2) / 2 - e));
}

double Waves::second_amplitude() const {
  if (order < 2) return 0;
  const double x = wave_number() * depth, s = std::sinh(x);
  return height * height / (32 * depth) * (3 * std::cosh(x) / (s * s * s) - 2 * stroke() / height);
}

double Waves::share(double t) const {
  const double rise = ramp.value_or(2 * period);
  if (t <= 0) return 0;
  return t < rise ? 0.5 * (1 - std::cos(std::numbers::pi * t / rise)) : 1;
}

Vec3 Waves::displacement(double t) const {
  const double part = share(t), phase = omega() * t;
  // The second-order part grows with the square of the height.
  return (0.5 * stroke() * part * std::sin(phase) +
          second_amplitude() * part * part * std::sin(2 * phase)) *
         direction;
}

double Waves::elevation(double distance, double t) const {
  const double k = wave_number(), part = share(t), phase = omega() * t - k * distance;
  double eta =
      0.5 * height * part * std::cos(phase) + evanescent(distance) * displacement(t).dot(direction);
  if (order >= 2) {
    // Stokes' second-order crest. Beyond kd = 20 its factor is 2 to all digits, and the functions
    // overflow.
    const double x = std::min(k * depth, 20.0), s = std::sinh(x);
    eta += k * height * height / 16 * std::cosh(x) * (2 + std::cosh(2 * x)) / (s * s * s) * part *
           part * std::cos(2 * phase);
  }
  return eta;
}

double Waves::evanescent(double distance) const {
  const double deep = omega() * omega() * depth / gravity;
  double sum = 0;
  // One root of -y tan y = deep between (n - 1/2) pi and n pi. Terms fall as 1/n^3, and faster away
  // from the piston.
  for (int n = 1; n <= 40; ++n) {
    double low = (n - 0.5) * std::numbers::pi, high = n * std::numbers::pi;
    for (int k = 0; k < 60; ++k) {
      const double y = 0.5 * (low + high);
      (-y * std::tan(y) < deep ? high : low) = y;
    }
    const double y = 0.5 * (low + high);
    sum -= 2 * deep * std::sin(2 * y) / (y * (2 * y + std::sin(2 * y))) *
           std::exp(-y * distance / depth);
  }
  return sum;
}

double Waves::absorbing_rate() const { return omega() * stroke() / height; }

}  // namespace sphgeo
