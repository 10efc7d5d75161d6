#pragma once
// Packs what pair sums need of wall particles.

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "effects/wall_pair.h"
#include "sph/world.h"

namespace sphgeo {

/// Writes both records of all wall particles from their fields (not the positions).
template <int Dim>
void pack_walls(World<Dim>& world) {
  const ParticleSet<Dim>& walls = world.set("walls");
  const double volume = std::pow(walls.spacing(), Dim);
  const auto& v = walls.vector(fields::velocity);
  const auto* a = walls.has(fields::acceleration) ? &walls.vector(fields::acceleration) : nullptr;  // null: at rest
  const auto& n = walls.vector(fields::normal);
  const auto& no_slip = walls.scalar(fields::no_slip);
  const auto& x = walls.vector(fields::position);
  const auto* corner = walls.has(fields::corner) ? &walls.scalar(fields::corner) : nullptr;  // null: no soil
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    auto& first = world.records("walls", 0).template get<T>();
    auto& second = world.records("walls", 1).template get<T>();
    parallel_for(walls.size(), [&](Index i) {
      T* one = first[i];
      T* two = second[i] - record_size;  // slots of the second record count on from the first
      one[wall_slot::volume] = static_cast<T>(volume);
      one[wall_slot::no_slip] = static_cast<T>(no_slip[i]);
      if (corner) two[wall_slot::face] = static_cast<T>(1 - (*corner)[i] * (1 - no_slip[i]));
      const Vec<Dim> g = world.pull(x[i]);
      two[wall_slot::push] = static_cast<T>(std::max(0.0, (a ? Vec<Dim>((*a)[i] - g) : Vec<Dim>(-g)).dot(n[i])));
      two[wall_slot::weight] = static_cast<T>(-g.dot(n[i]));
      for (int k = 0; k < Dim; ++k) {
        one[wall_slot::velocity + k] = static_cast<T>(v[i][k]);
        two[wall_slot::normal + k] = static_cast<T>(n[i][k]);
      }
    });
  });
}

}  // namespace sphgeo
