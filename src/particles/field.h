#pragma once
// One array of a particle set, with a lifetime that says whether it is saved.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/aligned.h"
#include "core/state_io.h"
#include "core/types.h"
#include "deck/unit.h"

namespace sphgeo {

/// Symmetric tensor: xx, yy, zz, xy, yz, xz, the order of VTK; three-dimensional in every scene.
using Sym3 = Eigen::Matrix<double, 6, 1>;

/// state: evolves and is saved. reference: fixed at t = 0 and saved. derived: recomputed, never
/// saved.
enum class Lifetime { state, reference, derived };

/// What the values of a field are; a tensor is symmetric, with 6 components in every dimension.
enum class FieldType { scalar, vector, tensor, tag, identity };

/// Description of a field; its name is used in decks, frames, plans and error texts.
struct FieldSpec {
  const char* name;
  FieldType type;
  Lifetime lifetime;
  Unit unit;
  const char* sentence;
};

/// Untyped face of a field, for the code that sorts, removes, saves and writes all of them alike.
class FieldBase {
 public:
  explicit FieldBase(const FieldSpec& spec) : spec_(&spec) {}
  virtual ~FieldBase() = default;
  const FieldSpec& spec() const { return *spec_; }
  virtual void resize(Index n) = 0;
  /// New element k is old element order[k]; order may be shorter than the field. `spare` is a field
  /// of the same type: its memory is used, and its values are undefined afterwards.
  virtual void permute(std::span<const std::uint32_t> order, FieldBase& spare) = 0;
  virtual std::size_t bytes() const = 0;
  /// Memory of the values alone, as a checkpoint holds them.
  virtual std::size_t value_bytes() const = 0;
  /// Saves all values under this name, or loads them for the number of particles of the field.
  virtual void save(StateSink& sink, const std::string& name) const = 0;
  virtual void load(const StateSource& source, const std::string& name) = 0;
  /// The first particle whose value is not finite, or -1.
  virtual Index first_not_finite() const = 0;

 private:
  const FieldSpec* spec_;
};

template <class T>
class Field final : public FieldBase {
 public:
  using FieldBase::FieldBase;

  T& operator[](Index i) { return values_[static_cast<std::size_t>(i)]; }
  const T& operator[](Index i) const { return values_[static_cast<std::size_t>(i)]; }
  Index size() const { return static_cast<Index>(values_.size()); }
  T* data() { return values_.data(); }
  const T* data() const { return values_.data(); }

  void resize(Index n) override;
  void permute(std::span<const std::uint32_t> order, FieldBase& spare) override;
  std::size_t bytes() const override { return values_.capacity() * sizeof(T); }
  std::size_t value_bytes() const override { return values_.size() * sizeof(T); }
  void save(StateSink& sink, const std::string& name) const override;
  void load(const StateSource& source, const std::string& name) override;
  Index first_not_finite() const override;

 private:
  static T zero() {
    if constexpr (std::is_arithmetic_v<T>) return T{0};
    else return T::Zero();
  }
  AlignedVector<T> values_;
};

}  // namespace sphgeo
