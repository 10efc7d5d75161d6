#pragma once
// Kernel sums on a perfect lattice, where the integrals that they approximate are 1.

#include <algorithm>
#include <cmath>

#include "sph/kernel.h"

namespace sphgeo {

struct LatticeSums {
  double number;  ///< sum of W dp^Dim, the particle itself included
  double moment;  ///< minus the sum of x dW/dx dp^Dim: the factor on the gradient of a linear field
};

/// Sums over a lattice of spacing dp [m].
template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double dp) {
  const int reach = static_cast<int>(std::ceil(kernel.support() / dp));
  const int reach_y = Dim == 3 ? reach : 0;
  LatticeSums sums{0, 0};
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach_y; j <= reach_y; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const double r2 = dp * dp * (i * i + j * j + k * k);
        sums.number += kernel.w(r2) * std::pow(dp, Dim);
        sums.moment -= kernel.dw_over_r(r2) * dp * dp * i * i * std::pow(dp, Dim);
      }
  return sums;
}

/// The sums over a lattice whose volume per particle is dp^Dim / share, for any share in (0, 1]:
/// water in soil has a larger spacing than the kernel is made for, and its sums are larger
/// (in 2D for h = 1.8 dp: 1.002 at 1, 1.012 at 0.5, 1.11 at 0.2).
template <int Dim>
class SpreadLattice {
 public:
  SpreadLattice(const Kernel<Dim>& kernel, double dp) {
    for (int k = 0; k <= parts; ++k)
      at_[k] = lattice_sums(kernel, dp * std::pow(least + (1 - least) * k / parts, -1.0 / Dim));
  }
  LatticeSums operator()(double share) const {
    const double s = std::clamp((share - least) / (1 - least), 0.0, 1.0) * parts;
    // A share that is not a number gives sums that are not numbers, which the guard detects.
    const int k = s >= 0 ? std::min(static_cast<int>(s), parts - 1) : 0;
    return {at_[k].number + (s - k) * (at_[k + 1].number - at_[k].number),
            at_[k].moment + (s - k) * (at_[k + 1].moment - at_[k].moment)};
  }

 private:
  static constexpr int parts = 128;
  static constexpr double least = 0.05;
  LatticeSums at_[parts + 1];
};

}  // namespace sphgeo
