#pragma once
// The water fraction of the run: smoothed with the kernel of the water (Eq. 56).

#include <vector>

#include "scene/water_target.h"

namespace sphgeo {

/// Target water fraction averaged with the water's kernel over the water and the soil around;
/// regions beyond both, such as walls, are excluded, as the run completes its sums there. Tabulated
/// on a grid of spacing dp, straight lines between. With the sharp fraction volumes and densities
/// would be off by several percent at every surface of soil.
class SmoothFraction {
 public:
  /// Around the box, for smoothing length h (m).
  SmoothFraction(const Shape& water, const WaterTarget& target, const Aabb& box, double dp,
                 double h, int dim);
  /// The fraction at a point of the box, at least WaterTarget::smallest, at most 1.
  double operator()(const Vec3& at) const;

 private:
  Vec3 origin_;
  double dp_;
  Index n_[3];
  std::vector<double> fraction_;
};

}  // namespace sphgeo
