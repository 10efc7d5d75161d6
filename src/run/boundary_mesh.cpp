#include "run/boundary_mesh.h"

#include <algorithm>

#include "boundaries/boundary.h"
#include "geometry/mesh.h"
#include "scene/build.h"

namespace sphgeo {

BoundaryMesh boundary_mesh(const Model& model, double time) {
  BoundaryMesh all;
  const Placement placement{model.resolution, support_radius(model), model.dimension};
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* wall = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    const auto solid = wall ? wall->solid(placement) : nullptr;
    if (!solid) continue;
    const SurfaceMesh mesh = surface_mesh(*solid, 2 * model.resolution, model.dimension);
    const auto first = static_cast<Index>(all.points.size());
    for (const Vec3& p : mesh.points)
      all.points.push_back(wall->motion ? wall->motion->position(p, time) : p);
    const auto add = [&](const auto& cells) {
      for (const auto& cell : cells) {
        for (const std::int32_t c : cell) all.corners.push_back(first + c);
        all.part.push_back(static_cast<std::int32_t>(b));
      }
    };
    if (model.dimension == 2) add(mesh.segments);
    else add(mesh.triangles);
  }
  return all;
}

bool boundaries_move(const Model& model) {
  return std::any_of(model.boundaries.begin(), model.boundaries.end(), [](const auto& b) {
    const auto* wall = dynamic_cast<const WallBoundary*>(b.get());
    return wall && wall->motion.has_value();
  });
}

}  // namespace sphgeo
