#include "scene/wall_corners.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "sph/cell_grid.h"

namespace sphgeo {
namespace {

/// A point of a wall's surface and the normal there.
struct SurfacePoint {
  Vec3 at, normal;
};

/// Outward normal of the surface of a solid that is nearest to a position; shorter than 1 where two
/// are equally near.
Vec3 normal_of(const Shape& solid, const Vec3& at, double dp, int dimension) {
  const double by = 1e-3 * dp;
  Vec3 slope = Vec3::Zero();
  for (int k = 0; k < 3; k += dimension == 2 ? 2 : 1)
    slope[k] = (solid.signed_distance(at + by * Vec3::Unit(k)) -
                solid.signed_distance(at - by * Vec3::Unit(k))) /
               (2 * by);
  return slope;
}

/// Adds the points of a wall's surface nearest to one of its particles that soil can reach: one
/// for a particle of the first layer, more at an edge, none for the others.
void add_surface(const std::vector<const WallPart*>& all, const WallPart& wall, const Vec3& p,
                 double dp, int dimension, std::vector<SurfacePoint>& surface) {
  if (wall.solid->signed_distance(p) < -dp) return;
  const std::size_t first = surface.size();
  const auto look_from = [&](const Vec3& surface_point) {
    const Vec3 n = normal_of(*wall.solid, surface_point, dp, dimension);
    if (n.norm() < 0.99) return false;
    const Vec3 at =
        p + ((surface_point - p).dot(n) - wall.solid->signed_distance(surface_point)) * n;
    const bool known =
        std::any_of(surface.begin() + static_cast<std::ptrdiff_t>(first), surface.end(),
                    [&](const SurfacePoint& s) { return s.normal.dot(n) > 0.99; });
    if (!known && !inside_any(all, &wall, at + 0.5 * dp * n, 0))
      surface.push_back({at, n.normalized()});
    return true;
  };
  if (look_from(p)) return;
  for (int k = 0; k < 3; k += dimension == 2 ? 2 : 1)
    for (const double by : {-0.1 * dp, 0.1 * dp}) look_from(p + by * Vec3::Unit(k));
}

/// Points of the surface of these walls that soil can reach. The normals of particles cannot be
/// used here: where another wall covers them they have been turned away from their own surface.
std::vector<SurfacePoint> surface_of(const std::vector<WallPart*>& walls, double dp,
                                     int dimension) {
  const std::vector<const WallPart*> all(walls.begin(), walls.end());
  std::vector<SurfacePoint> surface;
  for (const WallPart* wall : walls) {
    const auto n = static_cast<Index>(wall->points.size());
    std::vector<std::vector<SurfacePoint>> parts(
        static_cast<std::size_t>((n + block_size - 1) / block_size));
    parallel_blocks(n, block_size, [&](Index begin, Index end, Index b) {
      for (Index k = begin; k < end; ++k)
        add_surface(all, *wall, wall->points[static_cast<std::size_t>(k)].position, dp, dimension,
                    parts[static_cast<std::size_t>(b)]);
    });
    for (const auto& part : parts) surface.insert(surface.end(), part.begin(), part.end());
  }
  return surface;
}

/// Whether two parts of surfaces face each other, at less than 120 degrees.
bool enclose(const SurfacePoint& a, const SurfacePoint& b, double dp) {
  return a.normal.dot(b.normal) < 0.5 && (b.at - a.at).dot(a.normal) > 0.01 * dp &&
         (a.at - b.at).dot(b.normal) > 0.01 * dp;
}

template <int Dim>
void mark(const std::vector<WallPart*>& walls, double dp, double reach) {
  const std::vector<SurfacePoint> surface = surface_of(walls, dp, Dim);
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
      // Surface points behind which the particle lies, one for each direction of the normal.
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
