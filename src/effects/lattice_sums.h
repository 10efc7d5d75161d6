#pragma once
// What the kernel's sums give on a perfect lattice, where the integrals they stand for give 1.

#include <cmath>

#include "sph/kernel.h"

namespace sphgeo {

struct LatticeSums {
  double number;  ///< sum of W dp^Dim, the particle itself included
  double moment;  ///< minus the sum of x dW/dx dp^Dim: a linear field's gradient comes out this large
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

}  // namespace sphgeo
