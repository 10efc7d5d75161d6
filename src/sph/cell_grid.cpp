#include "sph/cell_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace sphgeo {

namespace {

// Vector loads may start at the last particle.
constexpr std::size_t slack = 16;

// Items of a block where a block touches counters that its neighbors touch too, and cells of a
// block of the table.
constexpr int large_block = 8 * block_size;

struct IntBox {
  std::int32_t lo[3], hi[3];
};

// A particle and its sorting key.
struct SortEntry {
  std::int64_t cell;
  Id id;
  std::uint32_t particle;

  bool operator<(const SortEntry& b) const {
    return std::tie(cell, id, particle) < std::tie(b.cell, b.id, b.particle);
  }
};

// Sorts at most `few` particles by id, then by index. Most stand in order already.
constexpr std::size_t few = 32;
void sort_few(std::uint32_t* particle, std::size_t count, std::span<const Id> ids) {
  Id id[few];
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t p = particle[k];
    const Id its = ids.empty() ? p : ids[p];
    std::size_t to = k;
    for (; to > 0 && (id[to - 1] > its || (id[to - 1] == its && particle[to - 1] > p)); --to) {
      id[to] = id[to - 1];
      particle[to] = particle[to - 1];
    }
    id[to] = its;
    particle[to] = p;
  }
}

// Sorts pieces, then merges two by two: on all threads.
void sort_in_pieces(std::vector<SortEntry>& entries) {
  const auto n = static_cast<Index>(entries.size());
  constexpr int piece = 16 * block_size;
  parallel_blocks(n, piece, [&](Index begin, Index end, Index) {
    std::sort(entries.begin() + begin, entries.begin() + end);
  });
  for (int sorted = piece; sorted < n; sorted *= 2)
    parallel_blocks(n, 2 * sorted, [&](Index begin, Index end, Index) {
      if (begin + sorted >= end) return;
      std::inplace_merge(entries.begin() + begin, entries.begin() + begin + sorted,
                         entries.begin() + end);
    });
}

// Adds n to a counter and returns what it was.
std::uint32_t take_slots(std::uint32_t& counter, std::uint32_t n, bool alone) {
  if (!alone) return std::atomic_ref(counter).fetch_add(n, std::memory_order_relaxed);
  const std::uint32_t before = counter;
  counter += n;
  return before;
}

// counts[k] becomes the sum of counts[0 ... k].
void sum_up(AlignedVector<std::uint32_t>& counts) {
  const auto n = static_cast<Index>(counts.size());
  std::vector<std::uint32_t> before(static_cast<std::size_t>((n + large_block - 1) / large_block));
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index b) {
    before[static_cast<std::size_t>(b)] =
        std::accumulate(counts.begin() + begin, counts.begin() + end, std::uint32_t{0});
  });
  std::exclusive_scan(before.begin(), before.end(), before.begin(), std::uint32_t{0});
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index b) {
    std::inclusive_scan(counts.begin() + begin, counts.begin() + end, counts.begin() + begin,
                        std::plus<>{}, before[static_cast<std::size_t>(b)]);
  });
}

}  // namespace

template <int Dim>
void CellGrid<Dim>::build(std::span<const Vec<Dim>> r, const FixedPoint<Dim>& frame, double reach,
                          std::span<const Id> ids) {
  if (r.size() >= (std::size_t{1} << 29) - 1)
    throw Error(ExitCode::usage, "a particle set is limited to 2^29 - 2 particles");
  frame_ = frame;
  size_ = r.size();
  const auto n = static_cast<Index>(size_);
  order_.resize(size_ + slack);
  for (int d = 0; d < Dim; ++d) {
    coordinate_[d].resize(size_ + slack);
    unsorted_[d].resize(size_);
  }

  // The box, per block of particles, then of all.
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  std::vector<IntBox> boxes(static_cast<std::size_t>((n + block_size - 1) / block_size));
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index b) {
    IntBox box{{most, most, most}, {0, 0, 0}};
    for (int d = 0; d < Dim; ++d) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        const std::int32_t x = frame_.to_fixed(r[i][d], d);
        unsorted_[d][i] = x;
        box.lo[d] = std::min(box.lo[d], x);
        box.hi[d] = std::max(box.hi[d], x);
      }
    }
    boxes[static_cast<std::size_t>(b)] = box;
  });
  IntBox box{{most, most, most}, {0, 0, 0}};
  for (const IntBox& b : boxes) {
    for (int d = 0; d < Dim; ++d) {
      box.lo[d] = std::min(box.lo[d], b.lo[d]);
      box.hi[d] = std::max(box.hi[d], b.hi[d]);
    }
  }

  choose_cells(box.lo, box.hi, reach);
  fill_buckets();
  sort_buckets(ids);
  for (std::size_t k = size_; k < size_ + slack; ++k) {
    order_[k] = 0;
    for (int d = 0; d < Dim; ++d) coordinate_[d][k] = 0;
  }
}

template <int Dim>
void CellGrid<Dim>::choose_cells(const std::int32_t* lo, const std::int32_t* hi, double reach) {
  // A quarter of a million to each axis are enough for any domain; so their number fits its type.
  constexpr double smallest_edge = 0x1p12;
  double cells = 1.0;
  for (int d = 0; d < Dim; ++d) {
    edge_[d] = std::max(reach * frame_.per_quantum, smallest_edge);
    // Short cells along x, as rows are cut there to what a search needs; a half was fastest.
    if (d == 0) edge_[d] *= 0.5;
    per_edge_[d] = 1.0 / edge_[d];
    const auto at = [&](double x) {
      return std::floor((x - FixedPoint<Dim>::lowest) * per_edge_[d]);
    };
    first_[d] = size_ > 0 ? at(lo[d]) : 0.0;
    last_[d] = size_ > 0 ? at(hi[d]) : 0.0;
    count_[d] = static_cast<std::int64_t>(last_[d] - first_[d]) + 1;
    cells *= static_cast<double>(count_[d]);
  }
  // Few enough buckets that clearing the table never costs more than the search.
  const double most_buckets = std::max(4.0 * static_cast<double>(size_), 4096.0);
  shift_ = 0;
  while (std::ldexp(cells, -shift_) > most_buckets) ++shift_;
}

// Counts the particles of each bucket and puts them there, in any order.
template <int Dim>
void CellGrid<Dim>::fill_buckets() {
  const auto n = static_cast<Index>(size_);
  const bool alone = threads() == 1;
  const std::int64_t cells = count_[0] * count_[1] * count_[2];
  const auto buckets = static_cast<std::size_t>(((cells - 1) >> shift_) + 1);
  start_.resize(buckets + 2);
  parallel_blocks(static_cast<Index>(start_.size()), large_block,
                  [&](Index begin, Index end, Index) {
                    std::fill(start_.begin() + begin, start_.begin() + end, 0);
                  });
  // Until coordinates by slot are known, their array holds the bucket of each particle. Particles
  // are taken in runs of one bucket, as most neighbors in memory are neighbors in the last order.
  std::int32_t* bucket_of = coordinate_[0].data();
  const auto take = [&](std::int32_t bucket, std::uint32_t ahead, Index run) {
    return take_slots(start_[static_cast<std::uint32_t>(bucket) + ahead],
                      static_cast<std::uint32_t>(run), alone);
  };
  // Counted two further on: summed up, the entry after a bucket's own is its begin, which moves to
  // its end as the bucket fills; so at last each bucket's own entry is its begin.
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index) {
    Index first = begin;
    for (Index i = begin; i < end; ++i) {
      std::int32_t x[Dim];
      for (int d = 0; d < Dim; ++d) x[d] = unsorted_[d][static_cast<std::size_t>(i)];
      bucket_of[i] = static_cast<std::int32_t>(key(x) >> shift_);
      if (bucket_of[i] == bucket_of[first]) continue;
      take(bucket_of[first], 2, i - first);
      first = i;
    }
    take(bucket_of[first], 2, end - first);
  });
  sum_up(start_);
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index) {
    for (Index i = begin, first = begin; i < end; first = i) {
      while (i < end && bucket_of[i] == bucket_of[first]) ++i;
      std::uint32_t place = take(bucket_of[first], 1, i - first);
      for (Index k = first; k < i; ++k) order_[place++] = static_cast<std::uint32_t>(k);
    }
  });
}

// Sorts the particles within each bucket, by cell and id.
template <int Dim>
void CellGrid<Dim>::sort_buckets(std::span<const Id> ids) {
  const auto entry = [&](std::size_t k) {
    const std::uint32_t particle = order_[k];
    std::int64_t cell_key = 0;
    if (shift_ > 0) {
      std::int32_t x[Dim];
      for (int d = 0; d < Dim; ++d) x[d] = unsorted_[d][particle];
      cell_key = key(x);
    }
    return SortEntry{cell_key, ids.empty() ? particle : ids[particle], particle};
  };
  const auto place = [&](std::size_t k, std::uint32_t particle) {
    order_[k] = particle;
    for (int d = 0; d < Dim; ++d) coordinate_[d][k] = unsorted_[d][particle];
  };
  // Buckets that would keep one thread busy while the others wait.
  constexpr std::size_t large = 64 * block_size;
  std::vector<std::size_t> large_buckets;
  std::mutex large_mutex;
  const auto sort_bucket = [&](std::size_t bucket, std::vector<SortEntry>& entries) {
    const std::size_t begin = start_[bucket], count = start_[bucket + 1] - begin;
    if (count > large) {
      const std::lock_guard lock(large_mutex);
      large_buckets.push_back(bucket);
      return;
    }
    if (shift_ == 0 && count <= few) {
      sort_few(order_.data() + begin, count, ids);
      for (std::size_t k = begin; k < begin + count; ++k) place(k, order_[k]);
      return;
    }
    if (entries.size() < count) entries.resize(2 * count);
    for (std::size_t k = 0; k < count; ++k) entries[k] = entry(begin + k);
    std::sort(entries.begin(), entries.begin() + static_cast<Index>(count));
    for (std::size_t k = 0; k < count; ++k) place(begin + k, entries[k].particle);
  };
  parallel_blocks(static_cast<Index>(start_.size()) - 2, large_block,
                  [&](Index first, Index last, Index) {
                    std::vector<SortEntry> entries(block_size);
                    for (Index b = first; b < last; ++b)
                      sort_bucket(static_cast<std::size_t>(b), entries);
                  });
  for (const std::size_t b : large_buckets) {
    const std::size_t begin = start_[b];
    std::vector<SortEntry> entries(start_[b + 1] - begin);
    const auto count = static_cast<Index>(entries.size());
    parallel_for(count, [&](Index k) {
      entries[static_cast<std::size_t>(k)] = entry(begin + static_cast<std::size_t>(k));
    });
    sort_in_pieces(entries);
    parallel_for(count, [&](Index k) {
      place(begin + static_cast<std::size_t>(k), entries[static_cast<std::size_t>(k)].particle);
    });
  }
}

template <int Dim>
std::size_t CellGrid<Dim>::search_slot(std::int64_t cell_key) const {
  const auto bucket = static_cast<std::size_t>(cell_key >> shift_);
  std::size_t begin = start_[bucket], end = start_[bucket + 1];
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    std::int32_t x[Dim];
    for (int d = 0; d < Dim; ++d) x[d] = coordinate_[d][middle];
    if (key(x) < cell_key) begin = middle + 1;
    else end = middle;
  }
  return begin;
}

template <int Dim>
void CellGrid<Dim>::set_sorted() {
  parallel_for(static_cast<Index>(size_), [&](Index k) {
    order_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(k);
  });
}

template <int Dim>
std::size_t CellGrid<Dim>::bytes() const {
  std::size_t words = start_.capacity() + order_.capacity();
  for (int d = 0; d < Dim; ++d) words += coordinate_[d].capacity() + unsorted_[d].capacity();
  return words * sizeof(std::uint32_t);
}

template class CellGrid<1>;
template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace sphgeo
