#pragma once
// All fields of one set of particles; the only place that grows, sorts and removes them.

#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "particles/fields.h"

namespace sphgeo {

/// Particles of one phase (or all wall particles), with spacing and smoothing length of their own.
template <int Dim>
class ParticleSet {
 public:
  ParticleSet(std::string name, std::string phase, double spacing, double smoothing_length)
      : name_(std::move(name)), phase_(std::move(phase)), spacing_(spacing), h_(smoothing_length) {}

  const std::string& name() const { return name_; }
  /// "water", "soil", "solid" or "wall".
  const std::string& phase() const { return phase_; }
  double spacing() const { return spacing_; }     ///< dp, m
  double smoothing_length() const { return h_; }  ///< h, m
  Index size() const { return size_; }

  /// Adds the field if it is not there yet.
  FieldBase& require(const FieldSpec& spec);
  bool has(const FieldSpec& spec) const { return fields_.contains(spec.name); }

  Field<double>& scalar(const FieldSpec& s) { return typed<double>(s); }
  Field<Vec<Dim>>& vector(const FieldSpec& s) { return typed<Vec<Dim>>(s); }
  Field<Sym3>& tensor(const FieldSpec& s) { return typed<Sym3>(s); }
  Field<std::int32_t>& tag(const FieldSpec& s) { return typed<std::int32_t>(s); }
  Field<Id>& ids() { return typed<Id>(fields::id); }
  const Field<double>& scalar(const FieldSpec& s) const { return typed<double>(s); }
  const Field<Vec<Dim>>& vector(const FieldSpec& s) const { return typed<Vec<Dim>>(s); }
  const Field<Sym3>& tensor(const FieldSpec& s) const { return typed<Sym3>(s); }
  const Field<std::int32_t>& tag(const FieldSpec& s) const { return typed<std::int32_t>(s); }
  const Field<Id>& ids() const { return typed<Id>(fields::id); }

  /// All fields by name, in alphabetical order.
  const std::map<std::string, std::unique_ptr<FieldBase>>& fields() const { return fields_; }

  void resize(Index n);
  /// Adds n particles at the end, with ids that no particle of the set has had; returns the index
  /// of the first. All other fields are for the caller to fill.
  Index append(Index n);
  /// New particle k is old particle order[k]; a shorter order removes the particles it leaves out.
  void permute(std::span<const std::uint32_t> order);
  /// Memory of all fields and of the spare ones [bytes].
  std::size_t bytes() const;

  /// Saves what does not follow from the deck: state and reference fields of all particles. load()
  /// takes as many particles as were saved.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

 private:
  template <class T>
  Field<T>& typed(const FieldSpec& s) const {
    const auto it = fields_.find(s.name);
    if (it == fields_.end()) throw std::logic_error("set " + name_ + " has no field " + s.name);
    return static_cast<Field<T>&>(*it->second);
  }

  std::string name_, phase_;
  double spacing_, h_;
  Index size_ = 0;
  Id next_id_ = 0;  // greater than all that were given
  std::map<std::string, std::unique_ptr<FieldBase>> fields_;
  // One per type of field: sorting changes places with it, and allocates nothing.
  std::map<FieldType, std::unique_ptr<FieldBase>> spares_;
};

extern template class ParticleSet<2>;
extern template class ParticleSet<3>;

}  // namespace sphgeo
