#include "sph/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace sphgeo {

namespace {

// Vector loads may start at the last particle.
constexpr std::size_t slack = 16;

struct IntBox {
  std::int32_t lo[3], hi[3];
};

}  // namespace

template <int Dim>
void CellGrid<Dim>::build(std::span<const Vec<Dim>> r, const FixedPoint<Dim>& frame, double reach) {
  if (r.size() >= (std::size_t{1} << 29) - 1)
    throw Error(ExitCode::usage, "a particle set is limited to 2^29 - 2 particles");
  frame_ = frame;
  size_ = r.size();
  const auto n = static_cast<Index>(size_);
  order_.resize(size_ + slack);
  key_.resize(size_);
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
  sort();
}

template <int Dim>
void CellGrid<Dim>::choose_cells(const std::int32_t* lo, const std::int32_t* hi, double reach) {
  // Few enough cells that clearing the table never costs more than the search.
  const double most_cells = std::max(16.0 * static_cast<double>(size_), 65536.0);
  double span[3] = {0, 0, 0};
  for (int d = 0; d < Dim; ++d) {
    if (size_ > 0) span[d] = static_cast<double>(hi[d]) - static_cast<double>(lo[d]);
    lowest_[d] = size_ > 0 ? static_cast<double>(lo[d]) : 0.0;
    edge_[d] = std::max(reach * frame_.per_quantum, 1.0);
  }
  // Short cells along x, as rows are cut there to what a search needs; a half was fastest.
  edge_[0] *= 0.5;
  for (;;) {
    double cells = 1.0;
    for (int d = 0; d < Dim; ++d) {
      last_[d] = std::floor(span[d] / edge_[d]);
      count_[d] = static_cast<std::int64_t>(last_[d]) + 1;
      per_cell_[d] = 1.0 / edge_[d];
      cells *= last_[d] + 1.0;
    }
    if (cells <= most_cells) break;
    for (double& edge : edge_) edge *= 1.25;
  }
  start_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
}

template <int Dim>
void CellGrid<Dim>::sort() {
  const std::size_t cells = start_.size() - 1;
  const auto n = static_cast<Index>(size_);
  // A stable counting sort: each thread counts a contiguous share of the particles, and the shares
  // are placed one after the other. So the order does not depend on how many shares there are.
  std::size_t shares = static_cast<std::size_t>(threads());
  if (shares * cells > 2 * size_ + 4096) shares = 1;
  const auto share_begin = [&](std::size_t s) { return size_ * s / shares; };
  std::vector<std::vector<std::uint32_t>> next(shares);

  parallel_blocks(static_cast<Index>(shares), 1, [&](Index share, Index, Index) {
    const auto s = static_cast<std::size_t>(share);
    next[s].assign(cells, 0);
    for (std::size_t i = share_begin(s); i < share_begin(s + 1); ++i) {
      std::int64_t key = 0;
      for (int d = Dim - 1; d >= 0; --d) key = key * count_[d] + cell(unsorted_[d][i], d);
      key_[i] = static_cast<std::uint32_t>(key);
      ++next[s][static_cast<std::size_t>(key)];
    }
  });
  std::uint32_t place = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    start_[c] = place;
    for (auto& share : next) {
      const std::uint32_t count = share[c];
      share[c] = place;
      place += count;
    }
  }
  start_[cells] = place;
  parallel_blocks(static_cast<Index>(shares), 1, [&](Index share, Index, Index) {
    const auto s = static_cast<std::size_t>(share);
    for (std::size_t i = share_begin(s); i < share_begin(s + 1); ++i)
      order_[next[s][key_[i]]++] = static_cast<std::uint32_t>(i);
  });
  parallel_for(n, [&](Index k) {
    const auto p = static_cast<std::size_t>(k);
    for (int d = 0; d < Dim; ++d) coordinate_[d][p] = unsorted_[d][order_[p]];
  });
  for (std::size_t k = size_; k < size_ + slack; ++k) {
    order_[k] = 0;
    for (int d = 0; d < Dim; ++d) coordinate_[d][k] = 0;
  }
}

template <int Dim>
void CellGrid<Dim>::set_sorted() {
  parallel_for(static_cast<Index>(size_), [&](Index k) {
    order_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(k);
  });
}

template <int Dim>
std::size_t CellGrid<Dim>::bytes() const {
  std::size_t words = start_.capacity() + order_.capacity() + key_.capacity();
  for (int d = 0; d < Dim; ++d) words += coordinate_[d].capacity() + unsorted_[d].capacity();
  return words * sizeof(std::uint32_t);
}

template class CellGrid<1>;
template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace sphgeo
