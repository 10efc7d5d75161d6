#include "run/boundary_mesh.h"

#include "boundaries/boundary.h"
#include "geometry/mesh.h"
#include "scene/build.h"

namespace sphgeo {

namespace {

const WallBoundary* wall_of(const Model& model, std::size_t boundary) {
  return dynamic_cast<const WallBoundary*>(model.boundaries[boundary].get());
}

}  // namespace

BoundaryMesh boundary_mesh(const Model& model) {
  BoundaryMesh all;
  const Placement placement{model.resolution, support_radius(model), model.dimension};
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const WallBoundary* wall = wall_of(model, b);
    const auto solid = wall ? wall->solid(placement) : nullptr;
    if (!solid) continue;
    const SurfaceMesh mesh = surface_mesh(*solid, 2 * model.resolution, model.dimension);
    const auto first = static_cast<Index>(all.points.size());
    all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
    all.point_part.resize(all.points.size(), static_cast<std::int32_t>(b));
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

std::vector<Vec3> points_at(const BoundaryMesh& mesh, const Model& model, double time) {
  std::vector<Vec3> points = mesh.points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const WallBoundary* wall = wall_of(model, static_cast<std::size_t>(mesh.point_part[k]));
    if (wall->motion) points[k] = wall->motion->position(points[k], time);
  }
  return points;
}

bool boundaries_move(const Model& model) {
  for (std::size_t b = 0; b < model.boundaries.size(); ++b)
    if (const WallBoundary* wall = wall_of(model, b); wall && wall->motion) return true;
  return false;
}

}  // namespace sphgeo
