#pragma once
// Heights of the surface of a set, where the kernel sum over it falls to one half.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "probes/scene_view.h"
#include "sph/surface_height.h"

namespace sphgeo {

/// Height of the topmost surface of the set at each position (z is ignored); empty where there is
/// none.
inline std::vector<std::optional<double>> surface_heights(const SceneView& scene,
                                                          const std::string& set,
                                                          const std::vector<Vec3>& positions) {
  std::vector<std::optional<double>> heights(positions.size());
  if (!scene.has_set(set) || scene.size(set) == 0) return heights;
  const double dp = scene.spacing(set);
  const auto x = scene.vector(set, fields::position);
  const auto volume = scene.scalar(set, fields::volume);
  const double reach = 2 * scene.smoothing_length(set);
  std::vector<double> top(positions.size(), -INFINITY), bottom(positions.size(), INFINITY);
  for (Index i = 0; i < scene.size(set); ++i) {
    const Vec3 p = x(i);
    for (std::size_t k = 0; k < positions.size(); ++k) {
      if (std::abs(p.x() - positions[k].x()) > reach || std::abs(p.y() - positions[k].y()) > reach)
        continue;
      top[k] = std::max(top[k], p.z());
      bottom[k] = std::min(bottom[k], p.z());
    }
  }
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const auto filled = [&](double z) {
      double sum = 0;
      scene.near(set, {positions[k].x(), positions[k].y(), z},
                 [&](Index i, double w) { sum += volume(i) * w; });
      return sum;
    };
    heights[k] = surface_height(top[k], bottom[k], dp, filled);
  }
  return heights;
}

}  // namespace sphgeo
