#pragma once
// Grids and neighbor lists of a scene: who is near whom since the last rearrangement.

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "particles/particle_set.h"
#include "sph/cell_grid.h"
#include "sph/fixed_point.h"
#include "sph/neighbor_list.h"
#include "sph/pair_weights.h"
#include "sph/particle_sets.h"

namespace sphgeo {

/// Lists by names of target and source set, grids by name of the set.
template <int Dim>
class Neighborhoods {
 public:
  using Key = std::pair<std::string, std::string>;

  void require(const std::string& target, const std::string& source);
  NeighborList& list(const std::string& target, const std::string& source);
  const std::map<Key, NeighborList>& lists() const { return lists_; }
  /// Pairs of solids within one body, by their reference positions; those of rigid bodies are left
  /// out.
  void require_reference(const std::string& set) { reference_lists_.try_emplace(set); }
  NeighborList& reference(const std::string& set) { return reference_lists_.at(set); }
  /// What is added to the weights of those pairs; empty unless an effect fills it.
  PairWeights<Dim>& reference_weights(const std::string& set) { return reference_weights_[set]; }
  const CellGrid<Dim>& grid(const std::string& set) const { return grids_.at(set); }
  bool has_grid(const std::string& set) const { return grids_.contains(set); }
  /// All grids are to be built anew, also those of sets at rest.
  void forget_grids() { grids_.clear(); }

  /// Fits the fixed-point frame to the domain and the largest support of a kernel, m.
  void fit(const Vec<Dim>& lo, const Vec<Dim>& hi, double reach);
  const FixedPoint<Dim>& frame() const { return frame_; }

  /// Sorts a set by the cells of the positions `at`, then by id, and keeps the grid.
  void sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at, double reach);
  /// Sorts solids by their reference positions, which also find their neighbors for good. To be
  /// done once, before their first place().
  void sort_at_rest(ParticleSet<Dim>& set, const SolidParameters& solids);
  /// The grid of a set as it is, without sorting it.
  void place(const ParticleSet<Dim>& set, double reach);
  /// Builds all lists by the positions of the particles, whose grids are up to date.
  void build_lists(const ParticleSets<Dim>& sets);
  /// The same by the positions at the last rearrangement.
  void rebuild_lists(const ParticleSets<Dim>& sets);

  /// The positions of a set at the last rearrangement, as its grid holds them: the same after
  /// save_positions() and load_positions().
  std::vector<Vec<Dim>> arranged_positions(const std::string& set) const;
  void save_positions(StateSink& sink, const std::string& set) const;
  std::vector<Vec<Dim>> load_positions(const StateSource& source, const std::string& set,
                                       Index count) const;

  std::size_t bytes() const;

 private:
  void build_list(const ParticleSets<Dim>& sets, const Key& key, NeighborList& list,
                  std::span<const Vec<Dim>> at);

  std::map<std::string, CellGrid<Dim>> grids_;
  std::map<Key, NeighborList> lists_;
  std::map<std::string, NeighborList> reference_lists_;
  std::map<std::string, PairWeights<Dim>> reference_weights_;
  FixedPoint<Dim> frame_;
};

extern template class Neighborhoods<2>;
extern template class Neighborhoods<3>;

}  // namespace sphgeo
