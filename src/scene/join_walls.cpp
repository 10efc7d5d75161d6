#include "scene/join_walls.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "sph/cell_grid.h"

namespace sphgeo {

bool inside_any(const std::vector<const WallPart*>& parts, const WallPart* but, const Vec3& at,
                double deeper_than) {
  return std::any_of(parts.begin(), parts.end(), [&](const WallPart* other) {
    return other != but && other->solid->box().contains(at) &&
           other->solid->signed_distance(at) < -deeper_than;
  });
}

namespace {

/// Where the ray from a wall particle along its normal leaves its own solid; empty when it does not
/// within the reach.
std::optional<Vec3> surface_ahead(const Shape& solid, const WallPoint& p, double dp, double reach) {
  for (double s = 0.25 * dp; s <= reach + dp; s += 0.25 * dp)
    if (const Vec3 at = p.position + s * p.normal; solid.signed_distance(at) > 0) return at;
  return std::nullopt;
}

void keep_first(const std::vector<const WallPart*>& earlier, WallPart& part, double dp) {
  std::vector<char> drop(part.points.size());
  parallel_for(static_cast<Index>(drop.size()), [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    drop[i] = inside_any(earlier, nullptr, part.points[i].position, 1e-6 * dp);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < drop.size(); ++i)
    if (!drop[i]) part.points[kept++] = part.points[i];
  part.points.resize(kept);
}

}  // namespace

template <int Dim>
void join_walls(std::vector<WallPart>& parts, double dp, double reach, const Vec3& up) {
  std::vector<const WallPart*> joined;
  for (WallPart& part : parts) {
    if (!part.rests || !part.solid) continue;
    keep_first(joined, part, dp);
    joined.push_back(&part);
  }
  if (joined.size() < 2) return;

  std::vector<Vec<Dim>> exposed;  // surface points that the fluid can reach
  std::vector<WallPoint*> hidden;
  for (WallPart& part : parts) {
    if (!part.rests || !part.solid) continue;
    std::vector<std::optional<Vec3>> ahead(part.points.size());
    std::vector<char> covered(part.points.size());
    parallel_for(static_cast<Index>(ahead.size()), [&](Index k) {
      const auto i = static_cast<std::size_t>(k);
      ahead[i] = surface_ahead(*part.solid, part.points[i], dp, reach);
      // Half a spacing farther: a narrower gap has no room for fluid.
      covered[i] =
          ahead[i] && inside_any(joined, &part, *ahead[i] + 0.5 * dp * part.points[i].normal, 0);
    });
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      if (covered[i]) hidden.push_back(&part.points[i]);
      else if (ahead[i]) exposed.push_back(to_scene<Dim>(*ahead[i]));
    }
  }
  if (hidden.empty() || exposed.empty()) return;

  Vec<Dim> lo = exposed.front(), hi = lo;
  const auto extend = [&](const Vec<Dim>& x) {
    lo = lo.cwiseMin(x);
    hi = hi.cwiseMax(x);
  };
  for (const Vec<Dim>& x : exposed) extend(x);
  for (const WallPoint* p : hidden) extend(to_scene<Dim>(p->position));
  CellGrid<Dim> grid;
  grid.build(exposed, FixedPoint<Dim>::fit(lo, hi, reach), reach);
  parallel_for(static_cast<Index>(hidden.size()), [&](Index k) {
    WallPoint& p = *hidden[static_cast<std::size_t>(k)];
    const Vec<Dim> at = to_scene<Dim>(p.position);
    double nearest = 4 * reach * reach;
    Index best = -1;
    grid.for_each_in_reach(at, 2 * reach, [&](Index j, double r2) {
      if (to_scene<Dim>(up).dot(exposed[static_cast<std::size_t>(j)] - at) > 0)
        r2 -= 0.01 * dp * dp;  // decides between equals
      if (r2 > nearest || (r2 == nearest && j > best)) return;
      nearest = r2;
      best = j;
    });
    if (best < 0) return;  // deeper than the kernel support
    const Vec3 towards = to_space<Dim>(Vec<Dim>(exposed[static_cast<std::size_t>(best)] - at));
    if (towards.norm() > 1e-6 * dp) p.normal = towards.normalized();
  });
}

template void join_walls<2>(std::vector<WallPart>&, double, double, const Vec3&);
template void join_walls<3>(std::vector<WallPart>&, double, double, const Vec3&);

}  // namespace sphgeo
