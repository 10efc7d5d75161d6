#include "sph/neighbor_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "sph/append_below.h"

namespace sphgeo {

namespace {

constexpr auto width = static_cast<std::size_t>(FloatLanes::width);
// Room for a full register past the end of any list.
constexpr std::size_t slack = 2 * NeighborList::padding;

IntLanes load_ints(const void* from) {
  IntLanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

FloatLanes to_float(IntLanes v) { return FloatLanes(__builtin_convertvector(v, FloatLanes::Raw)); }

// A search in units in which all differences are exact in single precision: quanta, or the power of
// two times a quantum that leaves 23 bits for four times the radius. So distances are symmetric.
struct Scale {
  int shift = 0;     // coordinates in these units: quanta >> shift
  double reach = 0;  // radius in quanta
  float limit = 0;   // squared radius in these units

  explicit Scale(double radius_in_quanta) : reach(radius_in_quanta) {
    shift = std::max(0, std::ilogb(std::max(reach, 1.0)) + 3 - 23);
    const double r = std::ldexp(reach, -shift);
    limit = static_cast<float>(r * r);
  }
};

// The sources near a group of targets, copied together.
template <int Dim>
struct Candidates {
  std::size_t size = 0;
  std::int32_t corner[Dim];
  AlignedVector<float> x[Dim];  // from the corner
  AlignedVector<std::uint32_t> offset;

  // Collects all sources nearer than the reach to the box.
  void collect(const CellGrid<Dim>& sources, const std::int32_t* lo, const std::int32_t* hi,
               const Scale& scale) {
    size = 0;
    for (int d = 0; d < Dim; ++d) corner[d] = lo[d] >> scale.shift;
    sources.for_each_row(lo, hi, scale.reach, [&](std::size_t begin, std::size_t end) {
      make_room(size + (end - begin) + slack);
      for (std::size_t k = begin; k < end; k += width) {
        const std::size_t to = size + (k - begin);
        for (int d = 0; d < Dim; ++d) {
          const IntLanes at = load_ints(sources.slot_coordinate(d) + k) >> scale.shift;
          const FloatLanes from_corner = to_float(at - corner[d]);
          std::memcpy(x[d].data() + to, &from_corner, sizeof from_corner);
        }
        const IntLanes particle = load_ints(sources.slot_particle() + k) << 3;
        std::memcpy(offset.data() + to, &particle, sizeof particle);
      }
      size += end - begin;
    });
    // Out of reach.
    make_room(size + slack);
    for (std::size_t k = size; k < size + width; ++k) x[0][k] = 1e18f;
  }

  void make_room(std::size_t n) {
    if (n <= offset.size()) return;
    // Enough for most searches at once: to grow step by step took a tenth of their time.
    const std::size_t room = std::max(2 * n, std::size_t{2048});
    for (auto& column : x) column.resize(room);
    offset.resize(room);
  }
};

// Writes the candidates nearer to `at` than the limit to out and returns the end.
template <int Dim>
std::uint32_t* select_near(const Candidates<Dim>& candidates, const float* at, float limit,
                           std::int32_t self_offset, std::uint32_t* out) {
  for (std::size_t k = 0; k < candidates.size; k += width) {
    const auto square = [&](int d) {
      FloatLanes dx;
      std::memcpy(&dx, candidates.x[d].data() + k, sizeof dx);
      dx -= at[d];
      return dx * dx;
    };
    FloatLanes r2 = square(0);
    for (int d = 1; d < Dim; ++d) r2 += square(d);
    const IntLanes offset = load_ints(candidates.offset.data() + k);
    out = append_below(out, offset, r2, limit, self_offset);
  }
  return out;
}

// Releases memory that the next search will not need either, if it is much; `used` entries are
// kept.
void fit(AlignedVector<std::uint32_t>& entries, std::size_t used, std::size_t needed) {
  if (entries.capacity() <= needed + needed / 8) return;
  AlignedVector<std::uint32_t> fitted;
  fitted.resize(needed + needed / 32);
  std::copy_n(entries.begin(), used, fitted.begin());
  entries.swap(fitted);
}

template <int Dim>
void search_block(std::span<const Vec<Dim>> targets, const CellGrid<Dim>& sources,
                  const Scale& scale, Pairing pairing, Index begin, Index end,
                  NeighborList::Block& block) {
  const FixedPoint<Dim>& frame = sources.frame();
  const auto null_offset = static_cast<std::uint32_t>(sources.size() * 8);
  // Targets are searched in groups that are adjacent in memory; a group fits a box of this size.
  double box_size[3] = {scale.reach, scale.reach, scale.reach};
  box_size[0] *= 0.5;
  std::array<std::array<std::int32_t, Dim>, block_size> position;
  const auto count = static_cast<std::size_t>(end - begin);
  for (std::size_t k = 0; k < count; ++k)
    for (int d = 0; d < Dim; ++d)
      position[k][static_cast<std::size_t>(d)] =
          frame.to_fixed(targets[static_cast<std::size_t>(begin) + k][d], d);

  block.targets.clear();
  block.begin.clear();
  block.count.clear();
  std::size_t used = 0, most_candidates = 0;
  Candidates<Dim> candidates;
  for (std::size_t group = 0; group < count;) {
    std::array<std::int32_t, Dim> lo = position[group], hi = lo;
    std::size_t group_end = group + 1;
    for (; group_end < count; ++group_end) {
      auto new_lo = lo, new_hi = hi;
      bool fits = true;
      for (std::size_t d = 0; d < Dim; ++d) {
        new_lo[d] = std::min(lo[d], position[group_end][d]);
        new_hi[d] = std::max(hi[d], position[group_end][d]);
        fits &= static_cast<double>(new_hi[d] - new_lo[d]) <= box_size[d];
      }
      if (!fits) break;
      lo = new_lo;
      hi = new_hi;
    }
    candidates.collect(sources, lo.data(), hi.data(), scale);
    most_candidates = std::max(most_candidates, candidates.size);

    for (; group < group_end; ++group) {
      const auto i = static_cast<std::uint32_t>(begin) + static_cast<std::uint32_t>(group);
      float at[Dim];
      for (std::size_t d = 0; d < Dim; ++d)
        at[d] = static_cast<float>((position[group][d] >> scale.shift) - candidates.corner[d]);
      if (const std::size_t need = used + candidates.size + slack; need > block.entries.size())
        block.entries.resize(need + need / 2);
      std::uint32_t* first = block.entries.data() + used;
      const std::uint32_t* last = select_near<Dim>(
          candidates, at, scale.limit,
          pairing == Pairing::within ? static_cast<std::int32_t>(i << 3) : -1, first);
      const auto found = static_cast<std::size_t>(last - first);
      if (found == 0 && pairing == Pairing::across) continue;
      block.targets.push_back(i);
      block.begin.push_back(static_cast<std::uint32_t>(used));
      block.count.push_back(static_cast<std::uint32_t>(found));
      used += found;
      while (used % NeighborList::padding != 0) block.entries[used++] = null_offset;
    }
  }
  fit(block.entries, used, used + most_candidates + slack);
}

}  // namespace

template <int Dim>
void NeighborList::build(std::span<const Vec<Dim>> targets, const CellGrid<Dim>& sources,
                         double radius, Pairing pairing) {
  targets_ = static_cast<Index>(targets.size());
  sources_ = sources.size();
  if (targets_ >= (Index{1} << 29) - 1)
    throw Error(ExitCode::usage, "a particle set is limited to 2^29 - 2 particles");
  block_count_ = static_cast<std::size_t>((targets_ + block_size - 1) / block_size);
  // Blocks keep their memory from one search to the next.
  if (blocks_.size() < block_count_) blocks_.resize(block_count_);
  const Scale scale(radius * sources.frame().per_quantum);
  parallel_blocks(targets_, block_size, [&](Index begin, Index end, Index b) {
    search_block<Dim>(targets, sources, scale, pairing, begin, end,
                      blocks_[static_cast<std::size_t>(b)]);
  });
  count_pairs();
}

void NeighborList::count_pairs() {
  constexpr int some_blocks = 16;
  const auto n = static_cast<Index>(block_count_);
  std::vector<Count> parts(static_cast<std::size_t>((n + some_blocks - 1) / some_blocks));
  parallel_blocks(n, some_blocks, [&](Index first, Index last, Index part) {
    Count sum;
    for (Index b = first; b < last; ++b) {
      const Block& block = blocks_[static_cast<std::size_t>(b)];
      sum.active += static_cast<Index>(block.size());
      for (const std::uint32_t count : block.count) sum.pairs += count;
    }
    parts[static_cast<std::size_t>(part)] = sum;
  });
  count_ = {};
  for (const Count& part : parts) {
    count_.active += part.active;
    count_.pairs += part.pairs;
  }
}

std::size_t NeighborList::bytes() const {
  std::size_t words = 0;
  for (const Block& block : blocks_)
    words += block.targets.capacity() + block.begin.capacity() + block.count.capacity() +
             block.entries.capacity();
  return words * sizeof(std::uint32_t) + blocks_.capacity() * sizeof(Block);
}

template void NeighborList::build<1>(std::span<const Vec<1>>, const CellGrid<1>&, double, Pairing);
template void NeighborList::build<2>(std::span<const Vec<2>>, const CellGrid<2>&, double, Pairing);
template void NeighborList::build<3>(std::span<const Vec<3>>, const CellGrid<3>&, double, Pairing);

}  // namespace sphgeo
