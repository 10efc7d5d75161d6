#pragma once
// Everything that a running scene consists of: particle sets, packed records, grids and neighbor
// lists, gravity and the clocks. No physics.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "deck/model.h"
#include "particles/particle_set.h"
#include "sph/cell_grid.h"
#include "sph/fixed_point.h"
#include "sph/neighbor_list.h"
#include "sph/pair_weights.h"
#include "sph/record_store.h"

namespace sphgeo {

/// The clocks of Algorithm 2.
struct Clock {
  double time = 0;           ///< s
  double dt_acoustic = 0;    ///< of the running acoustic step, s
  double dt_advection = 0;   ///< of the running advection step, s
  double dt_solid = 0;       ///< of the running step of solids within it, s
  int solid_step = 0;        ///< its number within the acoustic step, from 0
  int solid_steps_each = 1;  ///< how many there are in the acoustic step, kappa
  long advection_steps = 0;
  long acoustic_steps = 0;
  long solid_steps = 0;
  /// Begin of the running step of solids, s.
  double solid_time() const { return time + solid_step * dt_solid; }
};

/// What came in and went out through one boundary so far; per metre of depth in 2D.
template <int Dim>
struct Exchanged {
  double entered = 0, left = 0;          ///< particles
  double mass = 0;                       ///< that came in, less what went out, kg
  Vec<Dim> momentum = Vec<Dim>::Zero();  ///< the same, kg m/s
  double energy = 0;                     ///< kinetic and potential, the same, J

  /// Adds what a particle brings (sign 1) or takes away (-1).
  void add(double sign, double m, const Vec<Dim>& at, const Vec<Dim>& v, const Vec<Dim>& gravity) {
    mass += sign * m;
    momentum += sign * m * v;
    energy += sign * m * (0.5 * v.squaredNorm() - gravity.dot(at));
  }
};

template <int Dim>
class World {
 public:
  explicit World(const Model& model);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Model& model() const { return model_; }
  const Vec<Dim>& gravity() const { return gravity_; }  ///< m/s2
  /// Gravity and the deck's body force at a place, now, m/s2.
  Vec<Dim> body_acceleration(const Vec<Dim>& at) const;
  Clock clock;

  /// Adds a set. `moves` is false for sets whose particles never change place.
  ParticleSet<Dim>& add_set(std::string name, std::string phase, double spacing, double h,
                            bool moves);
  /// Adds a set of solids: it moves, but keeps its particles, their order and their neighbors at
  /// rest. No list but the reference list pairs them: what touches them is the set "skin".
  ParticleSet<Dim>& add_solids(std::string name, double spacing, double h);
  /// Throws std::logic_error when there is none of that name.
  ParticleSet<Dim>& set(const std::string& name) const;
  ParticleSet<Dim>* find(const std::string& name) const;
  const std::vector<std::unique_ptr<ParticleSet<Dim>>>& sets() const { return sets_; }

  void require_list(const std::string& target, const std::string& source);
  NeighborList& list(const std::string& target, const std::string& source);
  const std::map<std::pair<std::string, std::string>, NeighborList>& lists() const {
    return lists_;
  }
  /// Pairs of solids within one body, by their reference positions; those of rigid bodies are left
  /// out.
  NeighborList& reference_list(const std::string& set) { return reference_lists_.at(set); }
  void require_reference_list(const std::string& set) { reference_lists_.try_emplace(set); }
  /// What is added to the weights of those pairs; empty unless an effect fills it.
  PairWeights<Dim>& reference_weights(const std::string& set) { return reference_weights_[set]; }
  const CellGrid<Dim>& grid(const std::string& set) const { return grids_.at(set); }

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

  /// Sets the box outside of which particles are lost and fits the fixed-point frame to it.
  void set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi);
  const Vec<Dim>& domain_lo() const { return lo_; }
  const Vec<Dim>& domain_hi() const { return hi_; }

  /// Line 28 of Algorithm 2: removes lost particles, sorts by cell, rebuilds grids and lists and
  /// the places in the records.
  void rearrange();
  /// Number of rearrangements so far: what was kept of single particles is void when it changes.
  long arrangement() const { return arrangement_; }
  /// Writes the positions of a set into its first records.
  void pack_positions(ParticleSet<Dim>& set);
  /// Particles that left the domain so far, by set.
  const std::map<std::string, Index>& lost() const { return lost_; }

  /// The book of a boundary that particles cross; made at the first call, saved and loaded.
  Exchanged<Dim>& exchanged(const std::string& boundary) { return exchanged_[boundary]; }
  const std::map<std::string, Exchanged<Dim>>& exchanged() const { return exchanged_; }
  /// A number that an effect keeps from step to step: 0 at first, saved and loaded.
  double& kept(const std::string& name) { return kept_[name]; }

  /// Whether the particles of a set change place.
  bool moves(const std::string& set) const { return moves_.at(set); }

  /// Memory of fields, records, grids and lists, bytes.
  std::size_t bytes() const;

  /// Saves clocks, domain, lost particles and all sets; everything else is rebuilt by rearrange().
  /// To be called between an advection step and the rearrangement that follows it. load() needs the
  /// sets of the same deck, with all fields that its plan asks for.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

  /// The same within an advection step, after save() and load(): the places at the last
  /// rearrangement, which lists and frozen pair geometry rest on. Loading rebuilds grids, lists and
  /// places in the records from them.
  void save_arrangement(StateSink& sink) const;
  void load_arrangement(const StateSource& source);
  /// The places of a set at the last rearrangement, as its grid holds them: the same after
  /// save_arrangement() and load_arrangement().
  std::vector<Vec<Dim>> arranged_places(const std::string& set) const;

 private:
  bool is_rigid(std::int32_t part) const;
  void arrange_solids(ParticleSet<Dim>& set);
  void remove_lost(ParticleSet<Dim>& set);
  void sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at);
  void build_list(const std::pair<std::string, std::string>& key, NeighborList& list,
                  std::span<const Vec<Dim>> at);
  double reach() const;

  const Model& model_;
  Vec<Dim> gravity_;
  bool single_, frozen_;
  std::vector<std::unique_ptr<ParticleSet<Dim>>> sets_;
  std::map<std::string, bool> moves_;
  std::map<std::string, CellGrid<Dim>> grids_;
  std::map<std::pair<std::string, std::string>, NeighborList> lists_;
  std::map<std::string, NeighborList> reference_lists_;
  std::map<std::string, PairWeights<Dim>> reference_weights_;
  RecordStore<Dim> records_;
  std::map<std::string, Index> lost_;
  std::map<std::string, Exchanged<Dim>> exchanged_;
  std::map<std::string, double> kept_;
  long arrangement_ = 0;
  Vec<Dim> lo_ = Vec<Dim>::Zero(), hi_ = Vec<Dim>::Zero();
  FixedPoint<Dim> frame_;
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
