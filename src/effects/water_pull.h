#pragma once
// What wall pairs need of water beside its first record.

#include "core/parallel.h"
#include "effects/wall_pair.h"

namespace sphgeo {

/// Packs g - dv/dt and the density of the targets of a list into the second records of water; with
/// drag, grad p / rho = g - dv/dt + drag. The drag is that of the last step, too: this step's comes
/// after all other forces, so it is not named among the needs of the effects that call this.
template <int Dim, class T>
void pack_water_pull(const World<Dim>& world, const NeighborList& list, Records<Dim, T>& records) {
  const ParticleSet<Dim>& water = world.set("water");
  const auto& x = water.vector(fields::position);
  const auto& a = water.vector(fields::acceleration);
  const auto& rho = water.scalar(fields::density);
  const Field<Vec<Dim>>* drag =
      water.has(fields::drag_acceleration) ? &water.vector(fields::drag_acceleration) : nullptr;
  const auto blocks = list.blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    for (const std::uint32_t i : blocks[static_cast<std::size_t>(b)].targets) {
      T* slot = records[i] - record_size;
      Vec<Dim> pull = world.pull(x[i]) - a[i];
      if (drag) pull += (*drag)[i];
      for (int k = 0; k < Dim; ++k) slot[water_slot::pull + k] = static_cast<T>(pull[k]);
      slot[water_slot::density] = static_cast<T>(rho[i]);
    }
  });
}

/// The reaction: the pair function of the force on water, seen from the wall.
template <int Dim>
struct WaterForceOnWall {
  WallPair<Dim> wall;
  static constexpr int scale =
      13;  ///< slot of what gradient_scale() makes of the force and of the volume in the record

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T, 2>& i, const Record<Dim, T, 2>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.force -= (j[water_slot::volume] * j[scale]) * wall.force(j, i, T(-1) * r, r2);
  }
};

}  // namespace sphgeo
