#pragma once
// The stress P . B of solids in its records: one in 2D, two in 3D.

#include <optional>
#include <string>

#include "effects/solid_packing.h"
#include "sph/world.h"

namespace sphgeo {

/// Writes the stress of a set of solids.
template <int Dim, class T>
class PiolaPacking {
 public:
  PiolaPacking(World<Dim>& world, const std::string& set)
      : first_(write_records<packed::Piola<Dim>, T>(world, set)) {
    if constexpr (Dim == 3) rest_ = write_records<packed::PiolaRest, T>(world, set);
  }
  void operator()(Index i, const Eigen::Matrix<double, Dim, Dim>& stress) const {
    constexpr int first = packed::first_piola_numbers<Dim>;
    for (int k = 0; k < Dim * Dim; ++k) {
      const double value = stress(k / Dim, k % Dim);
      if (k < first) first_[i].put(packed::Piola<Dim>::numbers, k, value);
      else (*rest_)[i].put(packed::PiolaRest::numbers, k - first, value);
    }
  }

 private:
  RecordPacking<packed::Piola<Dim>, T> first_;
  std::optional<RecordPacking<packed::PiolaRest, T>> rest_;  // in 3D
};

/// Reads it.
template <int Dim, class T>
class PiolaReading {
 public:
  PiolaReading(World<Dim>& world, const std::string& set)
      : first_(read_records<packed::Piola<Dim>, T>(world, set)) {
    if constexpr (Dim == 3) rest_ = read_records<packed::PiolaRest, T>(world, set);
  }
  /// Number k of P . B by rows, Pa.
  double get(Index i, int k) const {
    constexpr int first = packed::first_piola_numbers<Dim>;
    return k < first ? first_.get(i, packed::Piola<Dim>::numbers, k)
                     : rest_->get(i, packed::PiolaRest::numbers, k - first);
  }
  /// Its records, joined by others of the set.
  template <class... More>
  auto with_more(const More&... more) const {
    if constexpr (Dim == 2) return with<T>(first_, more...);
    else return with<T>(first_, *rest_, more...);
  }

 private:
  RecordSource<packed::Piola<Dim>, T> first_;
  std::optional<RecordSource<packed::PiolaRest, T>> rest_;  // in 3D
};

}  // namespace sphgeo
