#pragma once
// What kernels of several widths miss beyond the surface of the water.

#include <vector>

#include "geometry/level_set_mesh.h"

namespace sphgeo {

/// The second sum of Eq. 84 for smoothing lengths between two bounds: background meshes for a few
/// of them, and straight lines between.
class MissingSupport {
 public:
  /// Meshes around the box `around` for smoothing lengths from h_low to h_high, m; nodes are h/2.6
  /// apart.
  MissingSupport(const Shape& water, const Aabb& around, double h_low, double h_high, int dim);

  /// Sums over the outside of the water at p for the smoothing length h; zero deep inside.
  LevelSetMesh::Missing operator()(const Vec3& p, double h) const;

 private:
  std::vector<double> h_;
  std::vector<LevelSetMesh> mesh_;
};

}  // namespace sphgeo
