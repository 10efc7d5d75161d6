#pragma once
// Where the surface of walls lies that the fluid can reach.

#include <algorithm>
#include <optional>
#include <vector>

#include "scene/join_walls.h"

namespace sphgeo {

/// Where the ray from a wall particle along its normal leaves its own solid; empty when it does not within
/// the reach.
inline std::optional<Vec3> surface_ahead(const Shape& solid, const WallPoint& p, double dp, double reach) {
  for (double s = 0.25 * dp; s <= reach + dp; s += 0.25 * dp)
    if (const Vec3 at = p.position + s * p.normal; solid.signed_distance(at) > 0) return at;
  return std::nullopt;
}

/// Whether a place lies deeper in one of the solids, but for that of `but`, than `deeper_than`.
inline bool inside_any(const std::vector<const WallPart*>& parts, const WallPart* but, const Vec3& at, double deeper_than) {
  return std::any_of(parts.begin(), parts.end(), [&](const WallPart* other) {
    return other != but && other->solid->box().contains(at) && other->solid->signed_distance(at) < -deeper_than;
  });
}

}  // namespace sphgeo
