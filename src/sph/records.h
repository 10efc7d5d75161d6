#pragma once
// Packed copies of the few fields that one pass over pairs needs: 8 numbers per particle, in one
// half or one whole cache line.

#include <bit>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "core/aligned.h"
#include "core/types.h"
#include "sph/fixed_point.h"
#include "sph/lane_vec.h"
#include "sph/record_type.h"

namespace sphgeo {

/// n records of 8 numbers of type T (float or double), and the null record n, all zero: it pads
/// neighbor lists. A pair function must vanish for it, which it does if every term carries the
/// neighbor's volume (or mass) or a kernel, as the null record is out of everyone's reach.
/// Numbers 0 ... Dim-1 of a record with a position are written and read by set_position and
/// separation only (single precision keeps integers there, see FixedPoint). What the others mean is
/// said by record types.
template <int Dim, class T>
class Records {
 public:
  static constexpr int dim = Dim;
  using Number = T;

  Records() = default;
  Records(Index n, const FixedPoint<Dim>& frame) { resize(n, frame); }

  /// Makes room for n records and clears the null record. The others hold rubbish until written.
  void resize(Index n, const FixedPoint<Dim>& frame) {
    n_ = n;
    frame_ = frame;
    data_.resize(static_cast<std::size_t>((n + 1) * record_size));
    for (int k = 0; k < record_size; ++k) (*this)[n][k] = T(0);
  }

  Index size() const { return n_; }
  const FixedPoint<Dim>& frame() const { return frame_; }

  /// The 8 numbers of record i.
  T* operator[](Index i) { return data_.data() + i * record_size; }
  const T* operator[](Index i) const { return data_.data() + i * record_size; }
  const T* data() const { return data_.data(); }

  /// Writes the position [m] of record i.
  void set_position(Index i, const Vec<Dim>& r) {
    T* slot = (*this)[i];
    for (int k = 0; k < Dim; ++k) {
      if constexpr (sizeof(T) == 4) slot[k] = std::bit_cast<T>(frame_.to_fixed(r[k], k));
      else slot[k] = frame_.to_local(r[k], k);
    }
  }

  /// A stored position, as a number of its own kind: an integer in single precision.
  using Stored = std::conditional_t<sizeof(T) == 4, std::int32_t, double>;
  Stored stored_position(Index i, int k) const { return std::bit_cast<Stored>((*this)[i][k]); }
  void set_stored_position(Index i, int k, Stored to) { (*this)[i][k] = std::bit_cast<T>(to); }

  /// Memory in use [bytes].
  std::size_t bytes() const { return data_.capacity() * sizeof(T); }

 private:
  Index n_ = 0;
  FixedPoint<Dim> frame_;
  AlignedVector<T> data_;
};

/// One record of type R, to pack.
template <class R, class T>
class PackedRecord {
 public:
  explicit PackedRecord(T* slot) : slot_(slot) {}

  template <class Q, int At>
  void put(RecordField<Q, At>, double value) const {
    check<Q>();
    slot_[At] = static_cast<T>(value);
  }
  /// A vector.
  template <class Q, int At, int Count>
  requires(Count > 1) void put(RecordField<Q, At, Count>,
                               const std::type_identity_t<Vec<Count>>& value) const {
    check<Q>();
    for (int k = 0; k < Count; ++k) slot_[At + k] = static_cast<T>(value[k]);
  }
  /// Component k.
  template <class Q, int At, int Count>
  void put(RecordField<Q, At, Count>, int k, double value) const {
    check<Q>();
    slot_[At + k] = static_cast<T>(value);
  }

 private:
  template <class Q>
  static void check() {
    static_assert(std::is_same_v<Q, R>, "this record type has no such field");
  }

  T* slot_;
};

/// Records of type R of one set, to read.
template <class R, class T>
class RecordSource {
 public:
  using Type = R;
  static constexpr int dim = R::dim;

  explicit RecordSource(const Records<dim, T>& records) : records_(&records) {}

  const Records<dim, T>& records() const { return *records_; }
  /// Component k of a field of record i.
  template <class Q, int At, int Count>
  double get(Index i, RecordField<Q, At, Count>, int k = 0) const {
    static_assert(std::is_same_v<Q, R>, "this record type has no such field");
    return static_cast<double>((*records_)[i][At + k]);
  }

 private:
  const Records<dim, T>* records_;
};

/// Records of type R of one set, to pack.
template <class R, class T>
class RecordPacking : public RecordSource<R, T> {
 public:
  static constexpr int dim = R::dim;

  explicit RecordPacking(Records<dim, T>& records) : RecordSource<R, T>(records), to_(&records) {}

  PackedRecord<R, T> operator[](Index i) const { return PackedRecord<R, T>((*to_)[i]); }
  /// Writes the position [m] of record i.
  void set_position(Index i, const Vec<dim>& r) const {
    static_assert(std::is_same_v<decltype(R::position), const RecordField<R, 0, dim>>);
    to_->set_position(i, r);
  }

 private:
  Records<dim, T>* to_;
};

/// What a pair function sees of one side of a pair: one record of each type, side by side. The
/// position is that of the first, and not for reading: take r.
template <class T, class... R>
struct Record {
  T slot[sizeof...(R) * record_size];

  /// The type of the first record.
  using First = std::tuple_element_t<0, std::tuple<R...>>;
  static constexpr int dim = First::dim;

  template <class Q, int At>
  const T& operator[](RecordField<Q, At>) const {
    return slot[place<Q, 1U << At>() + At];
  }
  /// Component k of a field.
  template <class Q, int At, int Count>
  const T& at(RecordField<Q, At, Count>, int k) const {
    return slot[place<Q, RecordField<Q, At, Count>::slots>() + At + k];
  }
  template <class Q, int At, int Count>
  LaneVec<Count, T> vec(RecordField<Q, At, Count>) const {
    LaneVec<Count, T> v;
    for (int d = 0; d < Count; ++d)
      v[d] = slot[place<Q, RecordField<Q, At, Count>::slots>() + At + d];
    return v;
  }

 private:
  // Where the record that holds the fields of Q begins.
  template <class Q, unsigned Slots>
  static constexpr int place() {
    static_assert((holds_record<R, Q>() || ...), "this side of the pair has no such record");
    static_assert((free<R, Q, Slots>() && ...), "another record covers this field");
    int n = 0, found = 0;
    ((holds_record<R, Q>() ? void(found = n++) : void(++n)), ...);
    return found * record_size;
  }
  template <class P, class Q, unsigned Slots>
  static constexpr bool free() {
    if constexpr (holds_record<P, Q>()) return (covered_slots<P, Q>() & Slots) == 0;
    else return true;
  }
};

/// Record arrays of one set, read together.
template <class T, class... R>
struct RecordView {
  using First = std::tuple_element_t<0, std::tuple<R...>>;
  static constexpr int dim = First::dim;
  static constexpr int parts = sizeof...(R);

  const Records<dim, T>* part[parts];

  const FixedPoint<dim>& frame() const { return part[0]->frame(); }
  Index size() const { return part[0]->size(); }
};

template <class R, class T>
RecordView<T, R> view(const RecordSource<R, T>& a) {
  return {{&a.records()}};
}
template <class T, class... R>
RecordView<T, R...> view(const RecordView<T, R...>& a) {
  return a;
}

/// Records of several types of the same particles, for passes that need more than one record holds.
/// The position is taken from the first.
template <class T, class... R>
RecordView<T, R...> with(const RecordSource<R, T>&... each) {
  return {{&each.records()...}};
}

}  // namespace sphgeo
