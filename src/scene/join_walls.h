#pragma once
// Boundaries that touch or overlap become one wall.

#include <memory>
#include <vector>

#include "boundaries/boundary.h"

namespace sphgeo {

/// The particles of one boundary, and its solid (null: it has none, and is not joined).
struct WallPart {
  std::vector<WallPoint> points;
  std::shared_ptr<const Shape> solid;
  bool rests = true;  ///< only boundaries at rest are joined: others may separate again
};

/// Whether a position lies deeper than `deeper_than` in one of the solids except that of `but`.
bool inside_any(const std::vector<const WallPart*>& parts, const WallPart* but, const Vec3& at,
                double deeper_than);

/// Where solids overlap, keeps the particles of the first boundary: otherwise the kernel sum counts
/// the region twice. Normals that would point into another solid, as at the foot of a step that
/// stands on a floor, are turned towards the nearest surface that the fluid can reach; spacing dp
/// and reach of the kernel in m. Where two solids touch along a line, surfaces on both sides of it
/// are equally near: with `up` (of length 1) it is one of the upper side.
template <int Dim>
void join_walls(std::vector<WallPart>& parts, double dp, double reach,
                const Vec3& up = Vec3::Zero());

extern template void join_walls<2>(std::vector<WallPart>&, double, double, const Vec3&);
extern template void join_walls<3>(std::vector<WallPart>&, double, double, const Vec3&);

}  // namespace sphgeo
