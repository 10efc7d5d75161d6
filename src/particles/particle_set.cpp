#include "particles/particle_set.h"

#include "core/parallel.h"

namespace sphgeo {

template <class T>
void Field<T>::permute(const std::vector<std::uint32_t>& order) {
  spare_.resize(order.size(), zero());
  parallel_for(static_cast<Index>(order.size()), [&](Index k) {
    spare_[static_cast<std::size_t>(k)] = values_[order[static_cast<std::size_t>(k)]];
  });
  values_.swap(spare_);
}

template <int Dim>
FieldBase& ParticleSet<Dim>::require(const FieldSpec& spec) {
  auto& slot = fields_[spec.name];
  if (!slot) {
    switch (spec.type) {
      case FieldType::scalar: slot = std::make_unique<Field<double>>(spec); break;
      case FieldType::vector: slot = std::make_unique<Field<Vec<Dim>>>(spec); break;
      case FieldType::tag: slot = std::make_unique<Field<std::int32_t>>(spec); break;
      case FieldType::identity: slot = std::make_unique<Field<Id>>(spec); break;
    }
    slot->resize(size_);
  }
  return *slot;
}

template <int Dim>
double ParticleSet<Dim>::constant(const std::string& key) const {
  const auto it = constants_.find(key);
  if (it == constants_.end()) throw std::logic_error("set " + name_ + " has no constant " + key);
  return it->second;
}

template <int Dim>
void ParticleSet<Dim>::resize(Index n) {
  size_ = n;
  for (auto& [name, field] : fields_) field->resize(n);
}

template <int Dim>
void ParticleSet<Dim>::permute(const std::vector<std::uint32_t>& order) {
  size_ = static_cast<Index>(order.size());
  for (auto& [name, field] : fields_) field->permute(order);
}

template <int Dim>
std::size_t ParticleSet<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& [name, field] : fields_) sum += field->bytes();
  return sum;
}

template class ParticleSet<2>;
template class ParticleSet<3>;

}  // namespace sphgeo
