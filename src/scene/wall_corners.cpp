#include "scene/wall_corners.h"

#include <array>

#include "core/parallel.h"
#include "scene/surface_points.h"
#include "sph/cell_grid.h"

namespace sphgeo {
namespace {

/// A point of a wall's surface and the normal there.
struct SurfacePoint {
  Vec3 at, normal;
};

/// Points of the surface of these walls that soil can reach: one for each particle of the first layer.
std::vector<SurfacePoint> surface_of(const std::vector<WallPart*>& walls, double dp, double reach) {
  const std::vector<const WallPart*> all(walls.begin(), walls.end());
  std::vector<SurfacePoint> surface;
  for (const WallPart* wall : walls)
    for (const WallPoint& p : wall->points) {
      if (wall->solid->signed_distance(p.position) < -dp) continue;
      const auto at = surface_ahead(*wall->solid, p, dp, reach);
      if (at && !inside_any(all, wall, *at + 0.5 * dp * p.normal, 0)) surface.push_back({*at, p.normal});
    }
  return surface;
}

/// Whether two pieces of surface stand in front of each other, at less than 120 degrees.
bool enclose(const SurfacePoint& a, const SurfacePoint& b, double dp) {
  return a.normal.dot(b.normal) < 0.5 && (b.at - a.at).dot(a.normal) > -0.25 * dp && (a.at - b.at).dot(b.normal) > -0.25 * dp;
}

template <int Dim>
void mark(const std::vector<WallPart*>& walls, double dp, double reach) {
  const std::vector<SurfacePoint> surface = surface_of(walls, dp, reach);
  if (surface.empty()) return;
  std::vector<Vec<Dim>> at;
  for (const SurfacePoint& s : surface) at.push_back(to_scene<Dim>(s.at));
  Vec<Dim> lo = at.front(), hi = lo;
  const auto extend = [&](const Vec<Dim>& x) {
    lo = lo.cwiseMin(x);
    hi = hi.cwiseMax(x);
  };
  for (const Vec<Dim>& x : at) extend(x);
  for (const WallPart* wall : walls)
    for (const WallPoint& p : wall->points) extend(to_scene<Dim>(p.position));
  CellGrid<Dim> grid;
  grid.build(at, FixedPoint<Dim>::fit(lo, hi, reach), reach);

  for (WallPart* wall : walls)
    parallel_for(static_cast<Index>(wall->points.size()), [&](Index k) {
      WallPoint& p = wall->points[static_cast<std::size_t>(k)];
      // Points of surface in front of which it lies not, one for each direction of the normal.
      std::array<const SurfacePoint*, 16> seen{};
      std::size_t count = 0;
      grid.for_each_in_reach(to_scene<Dim>(p.position), reach + dp, [&](Index j, double) {
        const SurfacePoint& s = surface[static_cast<std::size_t>(j)];
        if (p.corner || (s.at - p.position).dot(s.normal) < 0.25 * dp) return;
        bool known = false;
        for (std::size_t n = 0; n < count; ++n) {
          p.corner = p.corner || enclose(*seen[n], s, dp);
          known = known || seen[n]->normal.dot(s.normal) > 0.99;
        }
        if (!known && count < seen.size()) seen[count++] = &s;
      });
    });
}

}  // namespace

template <int Dim>
void mark_corners(std::vector<WallPart>& parts, double dp, double reach) {
  std::vector<WallPart*> at_rest;
  for (WallPart& part : parts) {
    if (!part.solid) continue;
    if (part.rests) at_rest.push_back(&part);
    else mark<Dim>({&part}, dp, reach);
  }
  mark<Dim>(at_rest, dp, reach);
}

template void mark_corners<2>(std::vector<WallPart>&, double, double);
template void mark_corners<3>(std::vector<WallPart>&, double, double);

}  // namespace sphgeo
