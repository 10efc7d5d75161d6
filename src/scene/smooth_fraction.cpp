#include "scene/smooth_fraction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "sph/kernel.h"

namespace sphgeo {

SmoothFraction::SmoothFraction(const Shape& water, const WaterTarget& target, const Aabb& box,
                               double dp, double h, int dim)
    : dp_(dp) {
  const auto reach = static_cast<Index>(std::ceil(2 * h / dp));
  // One more node than the box, and cells as far around as the kernel reaches.
  Index cells[3];
  for (int k = 0; k < 3; ++k) {
    const bool flat = dim == 2 && k == 1;
    n_[k] = flat ? 1 : static_cast<Index>(std::ceil((box.hi[k] - box.lo[k]) / dp)) + 2;
    cells[k] = flat ? 1 : n_[k] + 2 * reach;
    origin_[k] = flat ? 0.0 : box.lo[k] - 0.5 * dp;
  }
  const Index margin_y = dim == 2 ? 0 : reach;
  const Vec3 first = origin_ - dp * Vec3(static_cast<double>(reach), static_cast<double>(margin_y),
                                         static_cast<double>(reach));
  std::vector<double> soil(static_cast<std::size_t>(cells[0] * cells[1] * cells[2])),
      filled(soil.size());
  parallel_for(static_cast<Index>(soil.size()), [&](Index c) {
    const Vec3 at = first + dp * Vec3(static_cast<double>(c % cells[0]),
                                      static_cast<double>(c / cells[0] % cells[1]),
                                      static_cast<double>(c / (cells[0] * cells[1])));
    double nearest = std::numeric_limits<double>::infinity();
    for (const WaterTarget::Skeleton& s : target.soils())
      nearest = std::min(nearest, distance_near(*s.shape, at, dp));
    // Farther inside does not count.
    if (nearest > -0.5 * dp) nearest = std::min(nearest, distance_near(water, at, dp));
    const auto k = static_cast<std::size_t>(c);
    filled[k] = std::clamp(0.5 - nearest / dp, 0.0, 1.0);
    soil[k] = std::clamp(1 - target.mean_fraction(at, dp), 0.0, 1.0);
  });
  std::vector<double> weights;
  std::vector<Index> offsets;
  for (Index z = -reach; z <= reach; ++z)
    for (Index y = -margin_y; y <= margin_y; ++y)
      for (Index x = -reach; x <= reach; ++x) {
        const double r2 = dp * dp * static_cast<double>(x * x + y * y + z * z);
        const double w = dim == 2 ? Kernel<2>(h).w(r2) : Kernel<3>(h).w(r2);
        if (w <= 0) continue;
        weights.push_back(w);
        offsets.push_back((z * cells[1] + y) * cells[0] + x);
      }
  fraction_.resize(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]));
  parallel_for(static_cast<Index>(fraction_.size()), [&](Index i) {
    const Index x = i % n_[0], y = i / n_[0] % n_[1], z = i / (n_[0] * n_[1]);
    const Index c = ((z + reach) * cells[1] + y + margin_y) * cells[0] + x + reach;
    double sum = 0, share = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const auto there = static_cast<std::size_t>(c + offsets[k]);
      sum += weights[k] * soil[there];
      share += weights[k] * filled[there];
    }
    fraction_[static_cast<std::size_t>(i)] =
        std::clamp(share > 0 ? 1 - sum / share : 1.0, WaterTarget::smallest, 1.0);
  });
}

double SmoothFraction::operator()(const Vec3& at) const {
  Index low[3];
  double part[3];
  for (int k = 0; k < 3; ++k) {
    const double s =
        n_[k] == 1 ? 0.0
                   : std::clamp((at[k] - origin_[k]) / dp_, 0.0, static_cast<double>(n_[k] - 1));
    low[k] = std::min(static_cast<Index>(s), std::max<Index>(n_[k] - 2, 0));
    part[k] = s - static_cast<double>(low[k]);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double w = 1;
    Index at_corner[3];
    for (int k = 0; k < 3; ++k) {
      const int up = (corner >> k) & 1;
      w *= up ? part[k] : 1 - part[k];
      at_corner[k] = std::min(low[k] + up, n_[k] - 1);
    }
    sum += w * fraction_[static_cast<std::size_t>((at_corner[2] * n_[1] + at_corner[1]) * n_[0] +
                                                  at_corner[0])];
  }
  return sum;
}

}  // namespace sphgeo
