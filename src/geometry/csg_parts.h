#pragma once
// What union, intersection and difference share.

#include "geometry/scene_check.h"

namespace sphgeo {

/// Inspects every part under its own key path.
inline void inspect_parts(const std::vector<ShapePtr>& parts, CheckContext& context) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    CheckContext part = context.inside("of[" + std::to_string(k) + "]");
    parts[k]->inspect(part);
  }
}

/// Boxes of the parts; in 2D they reach along all of y.
inline std::vector<Aabb> boxes_of(const std::vector<ShapePtr>& parts, bool flat) {
  std::vector<Aabb> out;
  for (const ShapePtr& part : parts) {
    out.push_back(part->box());
    if (flat) {
      out.back().lo.y() = -std::numeric_limits<double>::infinity();
      out.back().hi.y() = std::numeric_limits<double>::infinity();
    }
  }
  return out;
}

/// Whether a part is at least `distance` away from a point outside of its box: then it does not
/// affect the result and need not be evaluated. `boxes` may be empty, for shapes that are not made
/// by a deck.
inline bool farther(const std::vector<Aabb>& boxes, std::size_t part, const Vec3& at,
                    double distance) {
  if (part >= boxes.size()) return false;
  const double d2 = (boxes[part].lo - at).cwiseMax(at - boxes[part].hi).cwiseMax(0.0).squaredNorm();
  return d2 > 0.0 && (distance <= 0.0 || d2 >= distance * distance);
}

}  // namespace sphgeo
