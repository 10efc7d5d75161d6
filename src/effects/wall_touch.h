#pragma once
// What a solid's contact with walls rests on.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "effects/interface.h"
#include "sph/cell_grid.h"

namespace sphgeo {

/// Smoothing length of contacts with walls, in spacings of the wall. With 1.5 a plane of particles
/// is even to a ten-thousandth of a spacing; with the 1.15 of solids it would be to three
/// thousandths, more than most contacts are deep.
inline constexpr double wall_kernel = 1.5;

/// What a contact with walls needs of a body.
template <int Dim>
struct WallTouch {
  Kernel<Dim> kernel;
  double gap = 0;  ///< between the centres of its particles and those of a wall when both touch, m
  double reference_overlap = 0;  ///< sum of W V over a plane wall there
  bool rigid = false;
  double mass = 0;     ///< of the body, kg
  Index touching = 0;  ///< its particles that touch a wall in this step
};

/// Walls as an interface particle sees them.
template <int Dim>
struct WallSums {
  double sum = 0;                        ///< of W V
  double bulk = 0;                       ///< weighted mean of what wall_bulk() says
  Vec<Dim> gradient = Vec<Dim>::Zero();  ///< of the sum, 1/m
  Vec<Dim> velocity = Vec<Dim>::Zero();  ///< weighted mean, m/s
};

/// Mean sum of W V over a layer of a lattice of spacing dp, at a distance from it, over all
/// positions along it.
template <int Dim>
double layer_sum(const Kernel<Dim>& kernel, double distance, double dp) {
  if (distance >= kernel.support()) return 0;
  constexpr int parts = 200;
  const double far = std::sqrt(kernel.support() * kernel.support() - distance * distance),
               step = far / parts;
  double sum = 0;
  for (int k = 0; k < parts; ++k) {
    const double s = (k + 0.5) * step;
    sum += kernel.w(distance * distance + s * s) * (Dim == 2 ? 2.0 : 2 * std::numbers::pi * s) *
           step * dp;
  }
  return sum;
}

/// The same over a lattice that fills a half-space from a distance on.
template <int Dim>
double half_space_sum(const Kernel<Dim>& kernel, double distance, double dp) {
  double sum = 0;
  for (double z = distance; z < kernel.support(); z += dp) sum += layer_sum(kernel, z, dp);
  return sum;
}

/// Two particles, and their squared distance, m2.
struct ReachedPair {
  Index i, j;
  double r2;
};

/// The pairs nearer than `reach` (m) of places and what the grid holds, in the order of the places.
/// Found by all threads.
template <int Dim>
std::vector<ReachedPair> pairs_in_reach(const Field<Vec<Dim>>& places, const CellGrid<Dim>& grid,
                                        double reach) {
  std::vector<std::vector<ReachedPair>> parts(
      static_cast<std::size_t>((places.size() + block_size - 1) / block_size));
  parallel_blocks(places.size(), block_size, [&](Index begin, Index end, Index b) {
    for (Index i = begin; i < end; ++i)
      grid.for_each_in_reach(places[i], reach, [&](Index j, double r2) {
        parts[static_cast<std::size_t>(b)].push_back({i, j, r2});
      });
  });
  std::vector<ReachedPair> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// How much wall there is around each particle of the walls, by id: the sum of W V, over what a
/// body sees of it that touches a half-space. A column or a plate of few layers has less, and is
/// touched where less of it is seen; the value is at most 1.
template <int Dim>
std::vector<double> wall_bulk(const World<Dim>& world) {
  const ParticleSet<Dim>& walls = world.set("walls");
  const double dp = walls.spacing(), volume = std::pow(dp, Dim);
  const Kernel<Dim> kernel(wall_kernel * dp);
  // Seen from where it is touched, a spacing off: layer by layer what the layer sees, weighted with
  // how well it is seen.
  double seen = 0, weights = 0;
  for (int k = 0; (k + 1) * dp < kernel.support(); ++k) {
    double around = 0;
    for (int j = 0; std::abs(j - k) * dp < kernel.support(); ++j)
      around += layer_sum(kernel, std::abs(j - k) * dp, dp);
    const double weight = layer_sum(kernel, (k + 1) * dp, dp);
    seen += weight * around;
    weights += weight;
  }
  const double plane = seen / weights;
  const auto& y = walls.vector(walls.has(fields::reference_position) ? fields::reference_position
                                                                     : fields::position);
  const auto& id = walls.ids();
  CellGrid<Dim> grid;
  std::vector<Vec<Dim>> at(static_cast<std::size_t>(walls.size()));
  parallel_for(walls.size(), [&](Index w) { at[static_cast<std::size_t>(w)] = y[w]; });
  grid.build(at, world.grid("interface").frame(), kernel.support(),
             {id.data(), static_cast<std::size_t>(id.size())});
  std::vector<double> bulk(static_cast<std::size_t>(walls.size()));
  parallel_for(walls.size(), [&](Index w) {
    double sum = 0;
    grid.for_each_in_reach(y[w], kernel.support(),
                           [&](Index, double r2) { sum += kernel.w(r2) * volume; });
    // Rounded: the order of a sum, and with it its last bits, may be another for a run that goes
    // on.
    bulk[static_cast<std::size_t>(id[w])] = std::min(1.0, std::round(1e8 * sum / plane) * 1e-8);
  });
  return bulk;
}

/// Where each body of the model touches walls, as it stands at t = 0. The map must be up to date;
/// `bulk` is that of wall_bulk().
template <int Dim>
std::vector<WallTouch<Dim>> wall_touches(const World<Dim>& world, const InterfaceMap<Dim>& map,
                                         const std::vector<std::string>& solids,
                                         const std::vector<double>& bulk) {
  const ParticleSet<Dim>&interface = world.set("interface"), &walls = world.set("walls");
  std::vector<WallTouch<Dim>> touch(world.parameters().solids.of.size());
  std::vector<Vec<Dim>> at(static_cast<std::size_t>(interface.size()));
  double most = 0;
  for (Index k = 0; k < interface.size(); ++k) {
    const auto& [of, i] = map.at(k);
    WallTouch<Dim>& t = touch[static_cast<std::size_t>(of->part[i])];
    at[static_cast<std::size_t>(k)] = of->reference_position[i];
    // Not finer than the wall, whose single particles it would see.
    const double h = std::max(of->smoothing_length, wall_kernel * walls.spacing());
    t.kernel = Kernel<Dim>(h);
    t.gap = 0.5 * (std::pow(of->reference_volume[i], 1.0 / Dim) + walls.spacing());
    most = std::max(most, t.kernel.support());
  }
  for (const std::string& name : solids) {
    const ParticleSet<Dim>& set = world.set(name);
    for (Index i = 0; i < set.size(); ++i)
      touch[static_cast<std::size_t>(set.tag(fields::part)[i])].mass += set.scalar(fields::mass)[i];
  }
  CellGrid<Dim> grid;
  grid.build(at, world.grid("interface").frame(), most);
  const auto& y = walls.vector(walls.has(fields::reference_position) ? fields::reference_position
                                                                     : fields::position);
  const auto& id = walls.ids();
  const std::vector<ReachedPair> pairs = pairs_in_reach<Dim>(y, grid, most);
  for (const ReachedPair& pair : pairs) {
    const auto& p = map.at(pair.j);
    if (p.of->clamp[p.i] >= 0) continue;
    double& gap = touch[static_cast<std::size_t>(p.of->part[p.i])].gap;
    gap = std::min(gap, std::sqrt(pair.r2));
  }
  for (std::size_t b = 0; b < touch.size(); ++b) {
    const SolidPart& p = world.parameters().solids.of[b];
    if (!p.is_solid) continue;
    touch[b].rigid = p.rigid();
    touch[b].reference_overlap = half_space_sum(touch[b].kernel, touch[b].gap, walls.spacing());
  }
  // Rows that start face to face see a little more than the mean over all positions: not to be
  // pushed apart, they get that. In a corner of two walls it would be too much for either alone.
  std::vector<double> sums(at.size(), 0), bulks(at.size(), 0);
  for (const auto& [w, k, r2] : pairs) {
    const auto& p = map.at(k);
    const double share = touch[static_cast<std::size_t>(p.of->part[p.i])].kernel.w(r2) *
                         std::pow(walls.spacing(), Dim);
    sums[static_cast<std::size_t>(k)] += share;
    bulks[static_cast<std::size_t>(k)] += share * bulk[static_cast<std::size_t>(id[w])];
  }
  std::vector<double> most_seen(touch.size(), 0);
  for (Index k = 0; k < interface.size(); ++k) {
    double& seen = most_seen[static_cast<std::size_t>(interface.tag(fields::part)[k])];
    const double sum = sums[static_cast<std::size_t>(k)];
    if (map.at(k).of->clamp[map.at(k).i] < 0 && sum > 0)
      seen = std::max(seen, sum * sum / bulks[static_cast<std::size_t>(k)]);
  }
  // Rounded up: the last bits of a sum depend on the order of the walls, which a run that goes on
  // may find them in anew.
  for (std::size_t b = 0; b < touch.size(); ++b)
    touch[b].reference_overlap =
        std::clamp(std::ceil(most_seen[b] * 1e9) * 1e-9, touch[b].reference_overlap,
                   1.15 * touch[b].reference_overlap);
  return touch;
}

}  // namespace sphgeo
