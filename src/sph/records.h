#pragma once
// Packed copies of the few fields that one pass over pairs needs: 8 numbers per particle, in one
// half or one whole cache line.

#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>

#include "core/aligned.h"
#include "core/types.h"
#include "sph/fixed_point.h"
#include "sph/lane_vec.h"

namespace sphgeo {

/// n records of 8 numbers of type T (float or double), and the null record n, all zero: it pads
/// neighbor lists. A pair function must vanish for it, which it does if every term carries the
/// neighbor's volume (or mass) or a kernel, as the null record is out of everyone's reach.
/// Slots 0 ... Dim-1 belong to the position, and are written and read by set_position and
/// separation only (single precision keeps integers there, see FixedPoint). The effect names the
/// others.
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

/// What a pair function sees of one side of a pair: N records of 8 numbers each. Number k of the
/// first record is [k], of the second [8 + k]. The position slots are not for reading: take r.
template <int Dim, class T, int N = 1>
struct Record {
  T slot[N * record_size];

  const T& operator[](int k) const { return slot[k]; }

  /// The vector that starts at slot k.
  LaneVec<Dim, T> vec(int k) const {
    LaneVec<Dim, T> v;
    for (int d = 0; d < Dim; ++d) v[d] = slot[k + d];
    return v;
  }
};

/// N record arrays of one set, read together.
template <int Dim, class T, int N>
struct RecordView {
  const Records<Dim, T>* part[N];

  const FixedPoint<Dim>& frame() const { return part[0]->frame(); }
  Index size() const { return part[0]->size(); }
};

template <int Dim, class T>
RecordView<Dim, T, 1> view(const Records<Dim, T>& a) {
  return {{&a}};
}
template <int Dim, class T, int N>
RecordView<Dim, T, N> view(const RecordView<Dim, T, N>& a) {
  return a;
}

/// Two record arrays of the same particles, for passes that need more than one record holds. The
/// position is taken from the first; the second may use all 8 slots.
template <int Dim, class T>
RecordView<Dim, T, 2> with(const Records<Dim, T>& a, const Records<Dim, T>& b) {
  return {{&a, &b}};
}

/// Three record arrays of the same particles.
template <int Dim, class T>
RecordView<Dim, T, 3> with(const Records<Dim, T>& a, const Records<Dim, T>& b,
                           const Records<Dim, T>& c) {
  return {{&a, &b, &c}};
}

}  // namespace sphgeo
