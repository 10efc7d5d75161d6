#pragma once
// From the interface of solids to the particles that it follows.

#include <memory>
#include <vector>

#include "core/parallel.h"
#include "effects/solid_phase.h"

namespace sphgeo {

/// The fields of a set of solids that its interface and what touches it need: lookups by name cost
/// more than the work.
template <int Dim>
struct SolidFields {
  Field<Vec<Dim>>&position, &velocity, &reference_position;
  const Field<double>&mass, &reference_volume;
  const Field<std::int32_t>&part, &clamp;
  Field<Vec<Dim>>* acceleration_sum;  ///< null where nothing asks for it
  double smoothing_length;

  explicit SolidFields(ParticleSet<Dim>& s)
      : position(s.vector(fields::position)),
        velocity(s.vector(fields::velocity)),
        reference_position(s.vector(fields::reference_position)),
        mass(s.scalar(fields::mass)),
        reference_volume(s.scalar(fields::reference_volume)),
        part(s.tag(fields::part)),
        clamp(s.tag(fields::clamp)),
        acceleration_sum(s.has(fields::acceleration_sum) ? &s.vector(fields::acceleration_sum)
                                                         : nullptr),
        smoothing_length(s.smoothing_length()) {}
};

/// A particle of a solid.
template <int Dim>
struct SolidParticle {
  const SolidFields<Dim>* of;
  Index i;
};

/// Which particle of which solid each interface particle follows. Solids keep their order, the
/// interface is sorted at every rearrangement.
template <int Dim>
class InterfaceMap {
 public:
  /// To be called after a rearrangement, before at().
  void update(const World<Dim>& world);
  const SolidParticle<Dim>& at(Index interface) const {
    return rows_[static_cast<std::size_t>(interface)];
  }
  std::size_t bytes() const;

 private:
  long arrangement_ = -1;
  std::vector<SolidParticle<Dim>> rows_;
  std::vector<std::unique_ptr<SolidFields<Dim>>> sets_;
  std::vector<std::vector<std::uint32_t>> index_of_id_;  // by set
};

template <int Dim>
void InterfaceMap<Dim>::update(const World<Dim>& world) {
  if (arrangement_ == world.arrangement()) return;
  arrangement_ = world.arrangement();
  if (sets_.empty())
    for (const std::string& name : solid_sets(world)) {
      ParticleSet<Dim>& set = world.set(name);
      sets_.push_back(std::make_unique<SolidFields<Dim>>(set));
      auto& places = index_of_id_.emplace_back(static_cast<std::size_t>(set.size()));
      parallel_for(set.size(), [&](Index i) {
        places[static_cast<std::size_t>(set.ids()[i])] = static_cast<std::uint32_t>(i);
      });
    }
  const ParticleSet<Dim>& interface = world.set("interface");
  const auto& source = interface.tag(fields::source);
  const auto& number = interface.tag(fields::source_set);
  rows_.resize(static_cast<std::size_t>(interface.size()));
  parallel_for(interface.size(), [&](Index k) {
    const auto n = static_cast<std::size_t>(number[k]);
    rows_[static_cast<std::size_t>(k)] = {
        sets_[n].get(), static_cast<Index>(index_of_id_[n][static_cast<std::size_t>(source[k])])};
  });
}

template <int Dim>
std::size_t InterfaceMap<Dim>::bytes() const {
  std::size_t sum = rows_.capacity() * sizeof(SolidParticle<Dim>);
  for (const auto& places : index_of_id_) sum += places.capacity() * sizeof(std::uint32_t);
  return sum;
}

}  // namespace sphgeo
