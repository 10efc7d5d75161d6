#pragma once
// Forces between water and walls: what wall pairs need of water beside its state, and the reaction.

#include "core/parallel.h"
#include "effects/wall_pair.h"

namespace sphgeo {

/// What a pass sees of a water particle at a wall.
template <int Dim, class T>
using WaterAtWall = Record<T, packed::WaterState<Dim>, packed::PressureGradient<Dim>>;

/// Names what pack_pressure_gradient() needs, and the record that it packs for the effect's own
/// pairs. Acceleration and drag are those of the last step: this step's come after all forces.
template <int Dim>
void need_pressure_gradient(Needs& needs) {
  needs.fields.push_back({"water", &fields::acceleration, Access::previous});
  needs.fields.push_back({"water", &fields::drag_acceleration, Access::previous, true});
  needs.fields.push_back({"water", &fields::density, Access::read});
  needs.record<packed::PressureGradient<Dim>>("water", Access::scratch);
}

/// Packs the pressure gradient over density, g - dv/dt, with drag g - dv/dt + drag, and the density
/// of the targets of a list.
template <int Dim, class T>
void pack_pressure_gradient(const World<Dim>& world, const NeighborList& list,
                            const RecordPacking<packed::PressureGradient<Dim>, T>& records) {
  using Gradient = packed::PressureGradient<Dim>;
  const ParticleSet<Dim>& water = world.set("water");
  const auto& x = water.vector(fields::position);
  const auto& a = water.vector(fields::acceleration);
  const auto& rho = water.scalar(fields::density);
  const Field<Vec<Dim>>* drag =
      water.has(fields::drag_acceleration) ? &water.vector(fields::drag_acceleration) : nullptr;
  const auto blocks = list.blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    for (const std::uint32_t i : blocks[static_cast<std::size_t>(b)].targets) {
      Vec<Dim> gradient = world.body_acceleration(x[i]) - a[i];
      if (drag) gradient += (*drag)[i];
      const auto record = records[i];
      record.put(Gradient::over_density, gradient);
      record.put(Gradient::density, rho[i]);
    }
  });
}

/// The reaction: the pair function of the force on water, seen from the wall.
template <int Dim>
struct WaterForceOnWall {
  using Water = packed::WaterState<Dim>;
  WallPair<Dim> wall;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const WallRecord<Dim, T>& i,
                  const Record<T, Water, packed::PressureGradient<Dim>>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T scaled = j[Water::volume] * j[packed::PressureGradient<Dim>::reaction_scale];
    sum.force -= scaled * wall.force(j, i, T(-1) * r, r2);
  }
};

}  // namespace sphgeo
