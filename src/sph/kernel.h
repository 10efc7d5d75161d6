#pragma once
// The smoothing kernel: Wendland C2 (Eq. 102).

#include <numbers>

#include "sph/lanes.h"

namespace sphgeo {

/// Wendland C2 kernel with smoothing length h [m]; it vanishes beyond 2h (Eq. 102). All functions
/// take squared distances [m^2] as double, float or lanes of them.
template <int Dim>
struct Kernel {
  static_assert(Dim >= 1 && Dim <= 3);

  Kernel() = default;
  explicit Kernel(double smoothing_length) : h(smoothing_length) {
    // The constants normalize the kernel in one, two and three dimensions.
    if constexpr (Dim == 1) factor = 3.0 / (4.0 * h);
    if constexpr (Dim == 2) factor = 7.0 / (4.0 * std::numbers::pi * h * h);
    if constexpr (Dim == 3) factor = 21.0 / (16.0 * std::numbers::pi * h * h * h);
    half_over_h = 0.5 / h;
    slope = -5.0 * factor / (h * h);
  }

  double h = 0.0;            ///< smoothing length [m]
  double factor = 0.0;       ///< C_d of Eq. 102 [1/m^Dim]; W(0)
  double half_over_h = 0.0;  ///< 1 / (2h)
  double slope = 0.0;        ///< limit of W'(r)/r at r = 0

  /// Radius beyond which the kernel is zero [m].
  double support() const { return 2.0 * h; }

  /// W [1/m^Dim].
  template <class T>
  T w(T r2) const {
    const T half_q = length(r2) * T(half_over_h);
    // The order of arguments lets a NaN pass.
    const T s = max(T(0), T(1) - half_q);
    const T s2 = s * s;
    return s2 * s2 * (T(4) * half_q + T(1)) * T(factor);
  }

  /// W'(r) / r [1/m^(Dim+2)]: times the separation r_i - r_j it is the gradient of W at i.
  /// Negative, and regular at r = 0.
  template <class T>
  T dw_over_r(T r2) const {
    const T s = max(T(0), T(1) - length(r2) * T(half_over_h));
    return s * s * s * T(slope);
  }

  /// W'(r) [1/m^(Dim+1)], negative.
  template <class T>
  T dw(T r2) const {
    return dw_over_r(r2) * length(r2);
  }
};

}  // namespace sphgeo
