#pragma once
// Packs what pair sums need of wall particles.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "effects/wall_pair.h"
#include "sph/world.h"

namespace sphgeo {

/// Writes both records of particles of "walls", or of the "skin" of solids, from their fields (not
/// the positions): of all, or of `those` alone.
template <int Dim>
void pack_walls(World<Dim>& world, const std::string& name = "walls",
                const std::vector<Index>* those = nullptr) {
  const ParticleSet<Dim>& walls = world.set(name);
  const double volume = std::pow(walls.spacing(), Dim);
  const Field<double>* own_volume =
      walls.has(fields::reference_volume) ? &walls.scalar(fields::reference_volume) : nullptr;
  const auto& v = walls.vector(fields::velocity);
  const bool yields = name == "skin";
  const auto* a = !yields && walls.has(fields::acceleration) ? &walls.vector(fields::acceleration)
                                                             : nullptr;  // null: at rest
  const auto& n = walls.vector(fields::normal);
  const auto& no_slip = walls.scalar(fields::no_slip);
  const auto& x = walls.vector(fields::position);
  const auto* corner = walls.has(fields::corner) ? &walls.scalar(fields::corner)
                                                 : nullptr;  // null: no soil, or the skin of solids
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    auto& first = world.records(name, 0).template get<T>();
    auto& second = world.records(name, 1).template get<T>();
    parallel_for(those ? static_cast<Index>(those->size()) : walls.size(), [&](Index place) {
      const Index i = those ? (*those)[static_cast<std::size_t>(place)] : place;
      T* one = first[i];
      T* two = second[i] - record_size;  // slots of the second record count on from the first
      one[wall_slot::volume] = static_cast<T>(own_volume ? (*own_volume)[i] : volume);
      one[wall_slot::no_slip] = static_cast<T>(no_slip[i]);
      two[wall_slot::face] = static_cast<T>(corner ? 1 - (*corner)[i] * (1 - no_slip[i]) : 1.0);
      const Vec<Dim> g = world.pull(x[i]);
      const double weight = -g.dot(n[i]);
      two[wall_slot::push] =
          static_cast<T>(std::max(std::min(0.0, weight), weight + (a ? (*a)[i].dot(n[i]) : 0.0)));
      two[wall_slot::yields] = static_cast<T>(yields);
      two[wall_slot::near] =
          static_cast<T>(yields ? 0.85 * std::pow((*own_volume)[i], 1.0 / Dim) : 0.0);
      two[wall_slot::weight] = static_cast<T>(weight);
      for (int k = 0; k < Dim; ++k) {
        one[wall_slot::velocity + k] = static_cast<T>(v[i][k]);
        two[wall_slot::normal + k] = static_cast<T>(n[i][k]);
      }
    });
  });
}

}  // namespace sphgeo
