#pragma once
// Unit vectors.

#include <cmath>

#include "core/types.h"

namespace sphgeo {

/// The unit vector along `a`, also where the square of its length is no number in double precision;
/// zero for zero. What is a unit vector but for rounding stays as it is, so that a direction is its
/// own direction.
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
