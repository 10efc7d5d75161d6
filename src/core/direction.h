#pragma once
// Unit vectors.

#include <cmath>

#include "core/types.h"

namespace sphgeo {

/// The unit vector along `a`, also where the square of its length is not finite in double
/// precision; zero for zero. A unit vector (up to round-off) is returned unchanged, so that the
/// function is idempotent.
inline Vec3 direction_of(const Vec3& a) {
  const double largest = a.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return Vec3::Zero();
  const double square = a.squaredNorm();
  if (std::abs(square - 1) < 2e-15) return a;
  const Vec3 unit = std::isnormal(square) ? Vec3(a.normalized()) : Vec3((a / largest).normalized());
  // Components that have lost digits near zero turn nothing.
  return unit.unaryExpr([](double u) { return std::isnormal(u) ? u : 0.0; });
}

}  // namespace sphgeo
