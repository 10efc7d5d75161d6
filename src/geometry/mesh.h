#pragma once
// Surfaces of shapes as triangles (3D) or line segments (2D), for output and pictures.

#include <array>
#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

/// In 3D triangles with corners counter-clockwise seen from outside; in 2D segments (x, 0, z) with
/// the solid on their left in the x-z plane.
struct SurfaceMesh {
  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> segments;
};

/// The surface of a shape within `clip` (empty: no clip), found on a grid of about `spacing` (m):
/// every point lies on the surface; edges of the shape are cut off by up to a spacing. Boxes,
/// polygons in 2D and STL surfaces are passed on exactly. Throws Error (usage) when the shape is
/// unbounded in `clip`; the grid is coarsened so that it has at most 2e7 nodes.
SurfaceMesh surface_mesh(const Shape& shape, double spacing, int dim, const Aabb& clip = {});

}  // namespace sphgeo
