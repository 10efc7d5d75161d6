#include "geometry/shapes.h"

namespace sphgeo {

bool on_inner_seam(const Shape& shape, const Vec3& at, double reach, bool flat) {
  if (!shape.composed()) return false;
  // Beside a seam the solid continues in every direction; along it the bound stays zero.
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  for (int k = 0; k < 6; ++k) {
    if (flat && k % 3 == 1) continue;
    Vec3 p = at;
    p[k % 3] += k < 3 ? reach : -reach;
    const double d = shape.bound(p);
    most = std::max(most, d);
    least = std::min(least, d);
  }
  return most < 1e-2 * reach && least < -0.1 * reach;
}

}  // namespace sphgeo
