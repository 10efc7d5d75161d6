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

}  // namespace sphgeo
