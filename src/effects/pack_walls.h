#pragma once
// Packs what pair sums need of wall particles.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "effects/wall_pair.h"
#include "sph/world.h"

namespace sphgeo {

/// Names both records of a set of walls, which pack_walls() writes.
template <int Dim>
void need_wall_packing(Needs& needs, const std::string& name, Access access) {
  needs.record<packed::Wall<Dim>>(name, access);
  needs.record<packed::WallSurface<Dim>>(name, access);
}

/// Writes both records of particles of "walls", or of the "interface" of solids, from their fields
/// (not the positions): of all, or of `those` alone.
template <int Dim>
void pack_walls(World<Dim>& world, const std::string& name = "walls",
                const std::vector<Index>* those = nullptr) {
  using Wall = packed::Wall<Dim>;
  using Surface = packed::WallSurface<Dim>;
  const ParticleSet<Dim>& walls = world.set(name);
  const double volume = std::pow(walls.spacing(), Dim);
  const Field<double>* own_volume =
      walls.has(fields::reference_volume) ? &walls.scalar(fields::reference_volume) : nullptr;
  const auto& v = walls.vector(fields::velocity);
  const bool deformable = name == "interface";
  const auto* a = !deformable && walls.has(fields::acceleration)
                      ? &walls.vector(fields::acceleration)
                      : nullptr;  // null: at rest
  const auto& n = walls.vector(fields::normal);
  const auto& no_slip = walls.scalar(fields::no_slip);
  const auto& x = walls.vector(fields::position);
  const auto* corner = walls.has(fields::corner)
                           ? &walls.scalar(fields::corner)
                           : nullptr;  // null: no soil, or the interface of solids
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    const auto records = write_records<Wall, T>(world, name);
    const auto surfaces = write_records<Surface, T>(world, name);
    parallel_for(those ? static_cast<Index>(those->size()) : walls.size(), [&](Index place) {
      const Index i = those ? (*those)[static_cast<std::size_t>(place)] : place;
      const auto record = records[i];
      const auto surface = surfaces[i];
      record.put(Wall::volume, own_volume ? (*own_volume)[i] : volume);
      record.put(Wall::velocity, v[i]);
      record.put(Wall::no_slip, no_slip[i]);
      const Vec<Dim> g = world.body_acceleration(x[i]);
      const double weight = -g.dot(n[i]);
      surface.put(Surface::normal, n[i]);
      surface.put(Surface::face, corner ? 1 - (*corner)[i] * (1 - no_slip[i]) : 1.0);
      surface.put(Surface::push,
                  std::max(std::min(0.0, weight), weight + (a ? (*a)[i].dot(n[i]) : 0.0)));
      surface.put(Surface::weight, weight);
      surface.put(Surface::deformable, deformable);
      surface.put(Surface::near, deformable ? 0.85 * std::pow((*own_volume)[i], 1.0 / Dim) : 0.0);
    });
  });
}

}  // namespace sphgeo
