#pragma once
// The particle sets of a scene, and the domain that their particles live in.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "particles/particle_set.h"
#include "sph/parameters.h"

namespace sphgeo {

/// All sets, in the order in which they were added.
template <int Dim>
class ParticleSets {
 public:
  /// Adds a set. `moves` is false for sets whose particles never move.
  ParticleSet<Dim>& add(std::string name, std::string phase, double spacing, double h, bool moves);
  /// Throws std::logic_error when there is none of that name.
  ParticleSet<Dim>& at(const std::string& name) const;
  ParticleSet<Dim>* find(const std::string& name) const;
  const std::vector<std::unique_ptr<ParticleSet<Dim>>>& all() const { return sets_; }
  /// Whether the particles of a set move.
  bool moves(const std::string& name) const { return moves_.at(name); }
  /// The largest support of a kernel, m.
  double reach() const;

  /// Sets the box outside of which particles are lost, m.
  void set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi);
  const Vec<Dim>& domain_lo() const { return lo_; }
  const Vec<Dim>& domain_hi() const { return hi_; }
  /// Removes the particles of a set that are outside. Throws UnstableError, which names particle
  /// and time [s], when the set must not lose any: solids, all with OutsideDomain::stop; and when a
  /// position is not finite.
  void remove_lost(ParticleSet<Dim>& set, OutsideDomain policy, double time);
  /// Particles that left the domain so far, by set.
  const std::map<std::string, Index>& lost() const { return lost_; }

  std::size_t bytes() const;
  /// Saves domain, lost particles and all sets. load() needs the sets of the same deck, with all
  /// fields that its plan asks for.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

 private:
  std::vector<std::unique_ptr<ParticleSet<Dim>>> sets_;
  std::map<std::string, bool> moves_;
  std::map<std::string, Index> lost_;
  Vec<Dim> lo_ = Vec<Dim>::Zero(), hi_ = Vec<Dim>::Zero();
};

extern template class ParticleSets<2>;
extern template class ParticleSets<3>;

}  // namespace sphgeo
