#pragma once
// Positions as 32-bit integers: differences of single-precision pair loops are then exact however
// large the domain is.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/types.h"

namespace sphgeo {

/// Maps positions of one scene to integers in (0, 2^31): position = origin + quantum * integer. All
/// sets that are paired in a neighbor list use the same one. The box it is fitted to fills the
/// middle half of the range, and positions are clamped half way to its ends: any two integers
/// differ by less than 2^31, and the point 0, the position of null records, is out of reach of
/// every particle.
template <int Dim>
struct FixedPoint {
  Vec<Dim> origin = Vec<Dim>::Zero();  ///< position of the integer 0 [m]
  double quantum = 0x1p-24;            ///< one unit [m], a power of two
  double per_quantum = 0x1p24;         ///< 1 / quantum, exact
  /// Integers of positions are never below this.
  static constexpr double lowest = 0x1p28;

  /// Fits the range to a box [m]; `support` is the largest kernel support [m].
  static FixedPoint fit(const Vec<Dim>& lo, const Vec<Dim>& hi, double support) {
    double span = std::max((hi - lo).maxCoeff(), 8.0 * support);
    if (!(span > 0.0) || !std::isfinite(span)) span = 1.0;
    FixedPoint f;
    f.quantum = std::exp2(std::ceil(std::log2(span)) - 30);
    f.per_quantum = 1.0 / f.quantum;
    f.origin = 0.5 * (lo + hi) - Vec<Dim>::Constant(0x1p30 * f.quantum);
    return f;
  }

  /// Nearest integer of coordinate k; NaN and positions far below go to the lower end.
  std::int32_t to_fixed(double x, int k) const {
    return static_cast<std::int32_t>(to_local(x, k) * per_quantum + 0.5);
  }

  /// A position that to_fixed maps to these integers.
  Vec<Dim> place_of(const std::int32_t (&fixed)[Dim]) const {
    Vec<Dim> at;
    for (int k = 0; k < Dim; ++k) at[k] = origin[k] + quantum * fixed[k];
    return at;
  }

  /// Coordinate k relative to the origin [m], clamped to the range.
  double to_local(double x, int k) const {
    const double local = x - origin[k];
    const double low = lowest * quantum;
    const double high = 0x1.cp30 * quantum;
    return local > low ? (local < high ? local : high) : low;
  }

  bool operator==(const FixedPoint& b) const { return origin == b.origin && quantum == b.quantum; }
};

}  // namespace sphgeo
