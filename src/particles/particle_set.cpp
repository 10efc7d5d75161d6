#include "particles/particle_set.h"

#include <atomic>
#include <span>
#include <type_traits>

#include "core/parallel.h"

namespace sphgeo {

template <class T>
void Field<T>::resize(Index n) {
  const Index before = size();
  values_.resize(static_cast<std::size_t>(n));
  parallel_for(n - before, [&](Index k) { (*this)[before + k] = zero(); });
}

template <class T>
void Field<T>::permute(std::span<const std::uint32_t> order, FieldBase& spare) {
  AlignedVector<T>& to = static_cast<Field<T>&>(spare).values_;
  to.resize(order.size());
  parallel_for(static_cast<Index>(order.size()), [&](Index k) {
    to[static_cast<std::size_t>(k)] = values_[order[static_cast<std::size_t>(k)]];
  });
  values_.swap(to);
}

namespace {

// A field as plain numbers: what it holds, how many per particle.
template <class T>
auto numbers_of(T* values, Index n) {
  const auto count = static_cast<std::size_t>(n);
  if constexpr (std::is_arithmetic_v<std::remove_const_t<T>>) return std::span<T>(values, count);
  else {
    constexpr std::size_t components = std::remove_const_t<T>::SizeAtCompileTime;
    using Number = std::conditional_t<std::is_const_v<T>, const double, double>;
    return std::span<Number>(count > 0 ? values->data() : nullptr, count * components);
  }
}

template <int Dim>
std::unique_ptr<FieldBase> make_field(const FieldSpec& spec) {
  switch (spec.type) {
    case FieldType::scalar:
      return std::make_unique<Field<double>>(spec);
    case FieldType::vector:
      return std::make_unique<Field<Vec<Dim>>>(spec);
    case FieldType::tensor:
      return std::make_unique<Field<Sym3>>(spec);
    case FieldType::tag:
      return std::make_unique<Field<std::int32_t>>(spec);
    case FieldType::identity:
      return std::make_unique<Field<Id>>(spec);
  }
  return nullptr;
}

}  // namespace

template <class T>
void Field<T>::save(StateSink& sink, const std::string& name) const {
  if constexpr (std::is_arithmetic_v<T>) sink.put(name, numbers_of(data(), size()));
  else sink.put(name, numbers_of(data(), size()), T::SizeAtCompileTime);
}

template <class T>
void Field<T>::load(const StateSource& source, const std::string& name) {
  source.get(name, numbers_of(data(), size()));
}

template <class T>
Index Field<T>::first_not_finite() const {
  if constexpr (std::is_integral_v<T>) return -1;
  else {
    // 0 x is 0 for every number, and NaN for what is none: a sum of products, which vectorizes, and
    // costs one look at the memory.
    const auto all = numbers_of(data(), size());
    constexpr Index components = sizeof(T) / sizeof(double);
    const auto block_bad = [&](Index begin, Index end) {
      const auto* values = all.data();
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (Index k = begin * components; k < end * components; ++k) sum += 0.0 * values[k];
      return sum != 0.0;
    };
    constexpr int large_block = 16 * block_size;
    std::atomic<bool> bad{false};
    parallel_blocks(size(), large_block, [&](Index begin, Index end, Index) {
      if (block_bad(begin, end)) bad = true;
    });
    if (!bad) return -1;
    for (Index i = 0; i < size(); ++i)
      if (block_bad(i, i + 1)) return i;
    return -1;
  }
}

template <int Dim>
void ParticleSet<Dim>::save(StateSink& sink) const {
  const std::string at = "sets/" + name_ + "/";
  sink.put_count(at + "size", size_);
  sink.put_count(at + "next_id", static_cast<std::int64_t>(next_id_));
  for (const auto& [name, field] : fields_)
    if (field->spec().lifetime != Lifetime::derived) field->save(sink, at + name);
}

template <int Dim>
void ParticleSet<Dim>::load(const StateSource& source) {
  const std::string at = "sets/" + name_ + "/";
  resize(source.count(at + "size"));
  next_id_ = static_cast<Id>(source.count(at + "next_id"));
  for (auto& [name, field] : fields_)
    if (field->spec().lifetime != Lifetime::derived) field->load(source, at + name);
}

template <int Dim>
FieldBase& ParticleSet<Dim>::require(const FieldSpec& spec) {
  auto& slot = fields_[spec.name];
  if (!slot) {
    slot = make_field<Dim>(spec);
    slot->resize(size_);
  }
  return *slot;
}

template <int Dim>
void ParticleSet<Dim>::resize(Index n) {
  size_ = n;
  for (auto& [name, field] : fields_) field->resize(n);
  next_id_ = std::max(next_id_, static_cast<Id>(n));  // they are numbered by their index
}

template <int Dim>
Index ParticleSet<Dim>::append(Index n) {
  const Index first = size_;
  size_ += n;
  for (auto& [name, field] : fields_) field->resize(size_);
  for (Index i = first; i < size_; ++i) ids()[i] = next_id_++;
  return first;
}

template <int Dim>
void ParticleSet<Dim>::permute(std::span<const std::uint32_t> order) {
  size_ = static_cast<Index>(order.size());
  for (auto& [name, field] : fields_) {
    auto& spare = spares_[field->spec().type];
    if (!spare) spare = make_field<Dim>(field->spec());
    field->permute(order, *spare);
  }
}

template <int Dim>
std::size_t ParticleSet<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& [name, field] : fields_) sum += field->bytes();
  for (const auto& [type, spare] : spares_) sum += spare->bytes();
  return sum;
}

template class ParticleSet<2>;
template class ParticleSet<3>;

}  // namespace sphgeo
