#pragma once
// Water in soil: what the effects that couple the two share.
//
// Pairs of water and soil use the kernel of the water and the positions of the last rearrangement,
// whatever the other pairs of the soil use: their weights stay the same within an advection step,
// so what one phase gives is what the other takes, to round-off. A soil particle k counts with the
// volume of its grains, omega_k = m_k / rho^s = n_k V_k, which never changes. With it
//
//   n^s_i = sum_k omega_k W_ik / inside_i                              (Eq. 56; inside: the share
//   of the kernel outside of walls) v^s_i = sum_k P_ik v_k,  P_ik = omega_k W_ik / sum_l omega_l
//   W_il   (Eq. 57)
//
// and every force on the soil is spread with P, the adjoint of that mean: what water particle i
// hands over arrives as a whole.

#include "effects/pore_packing.h"
#include "effects/soil_phase.h"

namespace sphgeo {

/// Whether water and soil meet in this scene.
template <int Dim>
bool has_pore_water(const World<Dim>& world) {
  return world.find("water") && world.find("soil");
}

/// Whether some soil takes part in the motion: moved by forces or led.
template <int Dim>
bool soil_moves(const World<Dim>& world) {
  return world.parameters().soil.any_moves;
}

/// Names positions and weights of the pairs of water and soil.
template <int Dim>
void need_pore_pairs(Needs& needs) {
  for (const char* set : {"water", "soil"}) needs.record<packed::Pore<Dim>>(set, Access::read);
}

/// Calls f(i) for every target of a list, in parallel.
template <class F>
void for_targets(const NeighborList& list, F&& f) {
  const auto blocks = list.blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    for (const std::uint32_t i : blocks[static_cast<std::size_t>(b)].targets)
      f(static_cast<Index>(i));
  });
}

/// sum of weight_j W a_j; a is the vector of record type V.
template <class V>
struct WeightedVector {
  static constexpr int dim = V::dim;
  Kernel<dim> kernel;
  template <class T>
  struct Sums {
    LaneVec<dim, T> sum{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, packed::Pore<dim>>&, const Record<T, V>& j,
                  const LaneVec<dim, T>&, const T& r2) const {
    sum.sum += (kernel.w(r2) * j[packed::Pore<dim>::weight]) * j.vec(V::vector);
  }
};

/// finish(i, sum_j weight_j W_ij a_j) for every target that has a neighbor.
template <class V, int Dim, class Finish>
void gather_vectors(World<Dim>& world, const char* target, const char* source,
                    const Finish& finish) {
  const WeightedVector<V> pair{Kernel<Dim>(world.set("water").smoothing_length())};
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    gather<WeightedVector<V>::template Sums>(
        world.list(target, source), read_records<packed::Pore<Dim>, T>(world, target),
        read_records<V, T>(world, source), pair,
        [&](Index i, const auto& s) { finish(i, to_vec(s.sum)); });
  });
}

}  // namespace sphgeo
