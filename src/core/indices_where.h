#pragma once
// Which items of a set are of some kind, found by all threads.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace sphgeo {

/// The i in [0, n) for which holds(i), rising; asked once each, from all threads. n < 2^32.
template <class F>
std::vector<std::uint32_t> indices_where(Index n, F&& holds) {
  constexpr int large_block = 16 * block_size;
  std::vector<std::vector<std::uint32_t>> parts(
      static_cast<std::size_t>((n + large_block - 1) / large_block));
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index b) {
    auto& part = parts[static_cast<std::size_t>(b)];
    for (Index i = begin; i < end; ++i)
      if (holds(i)) part.push_back(static_cast<std::uint32_t>(i));
  });
  std::vector<std::size_t> first(parts.size());
  std::size_t sum = 0;
  for (std::size_t b = 0; b < parts.size(); ++b) {
    first[b] = sum;
    sum += parts[b].size();
  }
  std::vector<std::uint32_t> all(sum);
  parallel_blocks(static_cast<Index>(parts.size()), 1, [&](Index b, Index, Index) {
    const auto& part = parts[static_cast<std::size_t>(b)];
    std::copy(part.begin(), part.end(),
              all.begin() + static_cast<Index>(first[static_cast<std::size_t>(b)]));
  });
  return all;
}

}  // namespace sphgeo
