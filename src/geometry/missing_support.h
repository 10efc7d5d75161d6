#pragma once
// What kernels of several widths miss beyond the surface.

#include <vector>

#include "geometry/level_set_mesh.h"

namespace sphgeo {

/// The second sum of Eq. 84 for smoothing lengths between two bounds: background meshes for a few
/// of them, and straight lines between.
template <int Dim>
class MissingSupport {
 public:
  /// Meshes around the box `around` for smoothing lengths from h_low to h_high [m].
  MissingSupport(const Shape& shape, const Aabb& around, double h_low, double h_high);

  /// Sums over the outside of the shape at p for the smoothing length h; zero deep inside.
  typename LevelSetMesh<Dim>::Missing operator()(const Vec<Dim>& p, double h) const;

  /// The finest mesh; its band is as wide as the widest kernel reaches.
  const LevelSetMesh<Dim>& surface() const { return mesh_.front(); }

 private:
  std::vector<double> h_;
  std::vector<LevelSetMesh<Dim>> mesh_;
};

extern template class MissingSupport<2>;
extern template class MissingSupport<3>;

}  // namespace sphgeo
