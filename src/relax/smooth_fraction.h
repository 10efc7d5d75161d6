#pragma once
// The water fraction as a run will see it: smoothed with the kernel of the water (Eq. 56).

#include <vector>

#include "relax/water_target.h"

namespace sphgeo {

/// Target water fraction averaged with the water's kernel over the water and the soil around; what
/// lies beyond both, such as walls, takes no part, as the run completes its sums there. Tabulated
/// on a grid of spacing dp, straight lines between. Water set out for the sharp fraction would find
/// its volumes, and so its density, several percent off at every surface of soil.
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
