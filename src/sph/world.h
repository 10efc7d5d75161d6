#pragma once
// Everything that a running scene consists of: the table of parameters, clocks, particle sets,
// grids and neighbor lists, packed records and what has crossed boundaries, each kept by a class of
// its own. No physics.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "particles/particle_set.h"
#include "sph/boundary_ledger.h"
#include "sph/clock.h"
#include "sph/neighborhoods.h"
#include "sph/particle_sets.h"
#include "sph/pistons.h"
#include "sph/record_store.h"

namespace sphgeo {

template <int Dim>
class World {
 public:
  explicit World(std::shared_ptr<const Parameters> parameters);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// What the deck says to the effects; complete when the scene is built.
  const Parameters& parameters() const { return *parameters_; }
  const Vec<Dim>& gravity() const { return gravity_; }  ///< m/s2
  /// Gravity and the deck's body force at a position, now, m/s2.
  Vec<Dim> body_acceleration(const Vec<Dim>& at) const;
  Clock clock;

  /// Adds a set. `moves` is false for sets whose particles never move.
  ParticleSet<Dim>& add_set(std::string name, std::string phase, double spacing, double h,
                            bool moves) {
    return sets_.add(std::move(name), std::move(phase), spacing, h, moves);
  }
  /// Adds a set of solids: it moves, but keeps its particles, their order and their neighbors at
  /// rest. No list but the reference list pairs them: what touches them is the set "interface".
  ParticleSet<Dim>& add_solids(std::string name, double spacing, double h);
  /// Throws std::logic_error when there is none of that name.
  ParticleSet<Dim>& set(const std::string& name) const { return sets_.at(name); }
  ParticleSet<Dim>* find(const std::string& name) const { return sets_.find(name); }
  const std::vector<std::unique_ptr<ParticleSet<Dim>>>& sets() const { return sets_.all(); }
  /// Whether the particles of a set move.
  bool moves(const std::string& set) const { return sets_.moves(set); }
  /// Sets the box outside of which particles are lost and fits the fixed-point frame to it.
  void set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi);
  const Vec<Dim>& domain_lo() const { return sets_.domain_lo(); }
  const Vec<Dim>& domain_hi() const { return sets_.domain_hi(); }
  /// Particles that left the domain so far, by set.
  const std::map<std::string, Index>& lost() const { return sets_.lost(); }

  void require_list(const std::string& target, const std::string& source) {
    neighborhoods_.require(target, source);
  }
  NeighborList& list(const std::string& target, const std::string& source) {
    return neighborhoods_.list(target, source);
  }
  const auto& lists() const { return neighborhoods_.lists(); }
  void require_reference_list(const std::string& set) { neighborhoods_.require_reference(set); }
  NeighborList& reference_list(const std::string& set) { return neighborhoods_.reference(set); }
  PairWeights<Dim>& reference_weights(const std::string& set) {
    return neighborhoods_.reference_weights(set);
  }
  const CellGrid<Dim>& grid(const std::string& set) const { return neighborhoods_.grid(set); }
  /// The positions of a set at the last rearrangement, as its grid holds them.
  std::vector<Vec<Dim>> arranged_positions(const std::string& set) const {
    return neighborhoods_.arranged_positions(set);
  }

  /// Pair sums run in single or double precision: calls f with a value of that type.
  template <class F>
  void with_pair_precision(F&& f) {
    if (single_) f(float{});
    else f(double{});
  }
  bool single_precision() const { return single_; }
  /// Whether pair sums see positions of the last rearrangement (true) or of now.
  bool frozen_geometry() const { return frozen_; }
  /// Packed records: written by the effects, sized by rearrange().
  RecordStore<Dim>& records() { return records_; }
  const RecordStore<Dim>& records() const { return records_; }

  /// Line 28 of Algorithm 2: removes lost particles, sorts by cell, rebuilds grids and lists and
  /// the positions in the records.
  void rearrange();
  /// Number of rearrangements so far: what was kept of single particles is void when it changes.
  long arrangement() const { return arrangement_; }
  /// Writes the positions of a set into its first records.
  void pack_positions(ParticleSet<Dim>& set);
  /// What has crossed a boundary; the account is made at the first call.
  Exchanged<Dim>& exchanged(const std::string& boundary) { return ledger_[boundary]; }
  const std::map<std::string, Exchanged<Dim>>& exchanged() const { return ledger_.accounts(); }
  /// State of a wave maker with active wave absorption; made at the first call.
  PistonState& piston(const std::string& boundary) { return pistons_[boundary]; }

  /// Memory of fields, records, grids and lists, bytes.
  std::size_t bytes() const;

  /// Saves all parts but grids, lists and records, which rearrange() rebuilds. To be called between
  /// an advection step and the rearrangement that follows it. load() needs the sets of the same
  /// deck, with all fields that its plan asks for.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

  /// The same within an advection step, after save() and load(): the positions at the last
  /// rearrangement, which lists and frozen pair geometry rest on. Loading rebuilds grids, lists and
  /// positions in the records from them.
  void save_arrangement(StateSink& sink) const;
  void load_arrangement(const StateSource& source);

 private:
  void arrange_solids(ParticleSet<Dim>& set);
  void sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at);
  bool packed(const std::string& set) const { return records_.holds(set, 0); }
  void resize_records(const ParticleSet<Dim>& set);
  void load_packed(const StateSource& source, const std::string& set);

  std::shared_ptr<const Parameters> parameters_;
  Vec<Dim> gravity_;
  bool single_, frozen_;
  ParticleSets<Dim> sets_;
  Neighborhoods<Dim> neighborhoods_;
  RecordStore<Dim> records_;
  BoundaryLedger<Dim> ledger_;
  Pistons pistons_;
  long arrangement_ = 0;
};

extern template class World<2>;
extern template class World<3>;

/// Records of type R of a set in precision T, to read or to pack (see RecordStore).
template <class R, class T, int Dim>
RecordSource<R, T> read_records(World<Dim>& world, const std::string& set) {
  return world.records().template read<R, T>(set);
}
template <class R, class T, int Dim>
RecordPacking<R, T> write_records(World<Dim>& world, const std::string& set) {
  return world.records().template write<R, T>(set);
}

}  // namespace sphgeo
