#pragma once
// Vectors on some of the directed pairs of a set, kept by target and by source.

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Compressed rows: what belongs to row i stands at begin[i] ... begin[i + 1].
template <int Dim>
struct PairWeights {
  struct Entry {
    std::uint32_t other;
    float weight[Dim];
  };
  struct Rows {
    std::vector<std::uint32_t> begin;
    std::vector<Entry> entries;

    bool empty() const { return entries.empty(); }
    /// Calls f(other, weight) for the entries of row i.
    template <class F>
    void for_row(Index i, F&& f) const {
      for (std::uint32_t k = begin[static_cast<std::size_t>(i)];
           k < begin[static_cast<std::size_t>(i) + 1]; ++k)
        f(static_cast<Index>(entries[k].other), entries[k].weight);
    }
    std::size_t bytes() const {
      return begin.capacity() * sizeof(std::uint32_t) + entries.capacity() * sizeof(Entry);
    }
  };
  Rows by_target, by_source;

  bool empty() const { return by_target.empty(); }
  std::size_t bytes() const { return by_target.bytes() + by_source.bytes(); }
};

}  // namespace sphgeo
