#include "study/convergence.h"

#include <algorithm>
#include <cmath>

namespace sphgeo {

namespace {

constexpr double safe = 1.25, unsafe = 3;               ///< Roache's factors: three levels, fewer
constexpr double least_order = 0.5, largest_order = 4;  ///< outside of these no level is asymptotic

/// The observed order of three values by the fixed point of Celik's Eqs. 5: the ratios of the
/// spacings need not be equal. Empty when it does not converge.
std::optional<double> order_of_values(const Level& coarse, const Level& middle, const Level& fine) {
  const double r21 = middle.spacing / fine.spacing, r32 = coarse.spacing / middle.spacing;
  const double e21 = middle.value - fine.value, e32 = coarse.value - middle.value;
  const double sign = e32 / e21 > 0 ? 1 : -1;
  double p = 1;
  for (int k = 0; k < 200; ++k) {
    const double q = std::log((std::pow(r21, p) - sign) / (std::pow(r32, p) - sign));
    const double next = std::abs(std::log(std::abs(e32 / e21)) + q) / std::log(r21);
    if (!std::isfinite(next)) return {};
    if (std::abs(next - p) < 1e-10) return next;
    p = next;
  }
  return {};
}

/// Differences of the order of round-off are no change.
bool same(double a, double b) {
  return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::optional<double> order_of_errors(std::span<const Level> levels) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, largest = 0;
  for (const Level& level : levels) largest = std::max(largest, level.error.value_or(0));
  for (const Level& level : levels) {
    // An error a million times smaller than another one is round-off or chance, and has no order.
    if (!level.error || !(*level.error > 1e-6 * largest)) continue;
    const double x = std::log(level.spacing), y = std::log(*level.error);
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 2 || !(spread > 0)) return {};
  return (n * sxy - sx * sy) / spread;
}

Convergence convergence(std::span<const Level> levels) {
  Convergence c;
  c.label = "too few levels";
  if (levels.size() < 2) return c;
  const Level& fine = levels[levels.size() - 1];
  const Level& middle = levels[levels.size() - 2];
  const double e21 = middle.value - fine.value, ratio = middle.spacing / fine.spacing;
  const std::optional<double> of_errors = order_of_errors(levels);

  const auto cautious = [&] {
    const bool plausible = of_errors && *of_errors >= least_order && *of_errors <= 2;
    if (of_errors) {
      c.order = of_errors;
      c.order_from = "errors";
    }
    c.uncertainty = unsafe * std::abs(e21) / (std::pow(ratio, plausible ? *of_errors : 1.0) - 1);
  };
  if (levels.size() == 2) {
    cautious();
  } else {
    const Level& coarse = levels[levels.size() - 3];
    const double e32 = coarse.value - middle.value;
    if (same(fine.value, middle.value) && same(middle.value, coarse.value)) {
      c.label = "unchanged";
      c.uncertainty = 0;
    } else if (e21 * e32 < 0) {
      c.label = "oscillatory";
      if (of_errors) {
        c.order = of_errors;
        c.order_from = "errors";
      }
      const auto [least, most] = std::minmax({coarse.value, middle.value, fine.value});
      c.uncertainty = safe * (most - least) / 2;
    } else {
      const double r32 = coarse.spacing / middle.spacing;
      const std::optional<double> p =
          e21 != 0 && e32 != 0 ? order_of_values(coarse, middle, fine) : std::nullopt;
      // These are the ratios of values with an order of zero; Celik's formula takes an absolute
      // value and does not detect divergence.
      const bool shrinks = std::abs(e32) * std::log(ratio) > std::abs(e21) * std::log(r32);
      if (p && shrinks && *p >= least_order && *p <= largest_order) {
        c.label = "monotone";
        c.order = p;
        c.order_from = "values";
        const double step = -e21 / (std::pow(ratio, *p) - 1);
        c.extrapolated = fine.value + step;
        c.uncertainty = safe * std::abs(step);
      } else {
        c.label = "not in the asymptotic range";
        cautious();
      }
    }
  }
  if (c.uncertainty && fine.value != 0) c.gci = *c.uncertainty / std::abs(fine.value);
  return c;
}

}  // namespace sphgeo
