#include "relax/missing_support.h"

#include <algorithm>
#include <cmath>

namespace sphgeo {

namespace {
// Between smoothing lengths a factor of 1.2 apart a straight line is within 0.5 % of the sums.
constexpr double h_ratio = 1.2;
}  // namespace

MissingSupport::MissingSupport(const Shape& water, const Aabb& around, double h_low, double h_high,
                               int dim) {
  const int intervals =
      static_cast<int>(std::ceil(std::log(h_high / h_low) / std::log(h_ratio) - 1e-9));
  for (int k = 0; k <= intervals; ++k) {
    h_.push_back(intervals == 0
                     ? h_low
                     : h_low * std::pow(h_high / h_low, static_cast<double>(k) / intervals));
    mesh_.emplace_back(water, around, h_.back() / 2.6, RelaxKernel(h_.back(), dim), dim);
  }
}

LevelSetMesh::Missing MissingSupport::operator()(const Vec3& p, double h) const {
  const auto above = std::upper_bound(h_.begin(), h_.end(), h) - h_.begin();
  if (above == 0 || h_.size() == 1) return mesh_.front().missing(p);
  if (above == static_cast<std::ptrdiff_t>(h_.size())) return mesh_.back().missing(p);
  const auto k = static_cast<std::size_t>(above);
  const double share = (h - h_[k - 1]) / (h_[k] - h_[k - 1]);
  LevelSetMesh::Missing low = mesh_[k - 1].missing(p);
  const LevelSetMesh::Missing high = mesh_[k].missing(p);
  low.gradient = (1 - share) * low.gradient + share * high.gradient;
  low.sum = (1 - share) * low.sum + share * high.sum;
  return low;
}

}  // namespace sphgeo
