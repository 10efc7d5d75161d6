#pragma once
// Water in soil: what the effects that couple the two share.
//
// Pairs of water and soil use the kernel of the water and the places of the last rearrangement,
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

#include "effects/soil_phase.h"

namespace sphgeo {

/// Slots behind the position of the records that pairs of water and soil use: number 2 of water, 3
/// of soil.
namespace pore_slot {
inline constexpr int weight = 3;  ///< of soil: omega; of water: 1 / sum(omega W)
inline constexpr int vector = 4;  ///< what is averaged or handed over, Dim numbers
inline constexpr int other = 7;
}  // namespace pore_slot

inline constexpr int water_pore_record = 2;
inline constexpr int soil_pore_record = 3;

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

/// Records of the water or the soil for pairs of both.
template <class T, int Dim>
Records<Dim, T>& pore_records(World<Dim>& world, const char* set) {
  return world.records(set, set[0] == 'w' ? water_pore_record : soil_pore_record).template get<T>();
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

/// Writes a vector into the records of the pairs.
template <int Dim, class T>
void put_vector(T* record, const Vec<Dim>& a) {
  for (int k = 0; k < Dim; ++k) record[pore_slot::vector + k] = static_cast<T>(a[k]);
}

/// sum of weight_j W a_j.
template <int Dim>
struct WeightedVector {
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    LaneVec<Dim, T> sum{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T>&, const Record<Dim, T>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.sum += (kernel.w(r2) * j[pore_slot::weight]) * j.vec(pore_slot::vector);
  }
};

/// finish(i, sum_j weight_j W_ij a_j) for every target that has a neighbor.
template <int Dim, class Finish>
void gather_vectors(World<Dim>& world, const char* target, const char* source,
                    const Finish& finish) {
  const WeightedVector<Dim> pair{Kernel<Dim>(world.set("water").smoothing_length())};
  world.with_pair_precision([&](auto number) {
    using T = decltype(number);
    gather<WeightedVector<Dim>::template Sums>(
        world.list(target, source), pore_records<T>(world, target), pore_records<T>(world, source),
        pair, [&](Index i, const auto& s) { finish(i, to_vec(s.sum)); });
  });
}

}  // namespace sphgeo
