#include "sph/neighbor_list.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "sph/lanes.h"

namespace sphgeo {

namespace {

// Appends the sources of places [begin, end) that are near x to out; returns the new end.
template <int Dim>
std::uint32_t* search_row(const CellGrid<Dim>& sources, const std::int32_t* x, float limit,
                          std::int32_t self, std::size_t begin, std::size_t end,
                          std::uint32_t* out) {
  constexpr auto width = static_cast<std::size_t>(FloatLanes::width);
  IntLanes lane{};
  for (int k = 0; k < FloatLanes::width; ++k) lane[k] = k;
  const auto load = [](const void* from) {
    IntLanes v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  };
  for (std::size_t k = begin; k < end; k += width) {
    FloatLanes r2 = 0.0f;
    for (int d = 0; d < Dim; ++d) {
      // Exact: all coordinates are in [0, 2^31).
      const IntLanes difference = x[d] - load(sources.place_coordinate(d) + k);
      const FloatLanes dx = FloatLanes(__builtin_convertvector(difference, FloatLanes::Raw));
      r2 += dx * dx;
    }
    const IntLanes particle = load(sources.place_particle() + k);
    const auto left = static_cast<std::int32_t>(std::min(end - k, width));
    const IntLanes near = (r2 < FloatLanes(limit)) & (lane < left) & (particle != self);
    out = append_kept(out, particle << 3, near);
  }
  return out;
}

template <int Dim>
void search_block(std::span<const Vec<Dim>> targets, const CellGrid<Dim>& sources, double radius,
                  Pairing pairing, Index begin, Index end, NeighborList::Block& block) {
  const FixedPoint<Dim>& frame = sources.frame();
  const double reach = radius * frame.per_quantum;
  const auto limit = static_cast<float>(reach * reach);
  const auto null_offset = static_cast<std::uint32_t>(sources.size() * 8);
  // Room for a full register past the end of any list.
  constexpr std::size_t slack = 2 * NeighborList::padding;

  block.targets.clear();
  block.begin.clear();
  block.count.clear();
  std::size_t used = 0;
  for (Index i = begin; i < end; ++i) {
    std::int32_t x[Dim];
    for (int d = 0; d < Dim; ++d)
      x[d] = frame.to_fixed(targets[static_cast<std::size_t>(i)][d], d);
    const std::int32_t self = pairing == Pairing::within ? static_cast<std::int32_t>(i) : -1;
    const std::size_t first = used;
    sources.for_each_row(
        x, static_cast<std::int64_t>(reach) + 1, [&](std::size_t row_begin, std::size_t row_end) {
          const std::size_t need = used + (row_end - row_begin) + slack;
          if (need > block.entries.size()) block.entries.resize(need + need / 4);
          std::uint32_t* out = block.entries.data() + used;
          out = search_row<Dim>(sources, x, limit, self, row_begin, row_end, out);
          used = static_cast<std::size_t>(out - block.entries.data());
        });
    if (used == first && pairing == Pairing::across) continue;
    block.targets.push_back(static_cast<std::uint32_t>(i));
    block.begin.push_back(static_cast<std::uint32_t>(first));
    block.count.push_back(static_cast<std::uint32_t>(used - first));
    while (used % NeighborList::padding != 0) block.entries[used++] = null_offset;
  }
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
  parallel_blocks(targets_, block_size, [&](Index begin, Index end, Index b) {
    search_block<Dim>(targets, sources, radius, pairing, begin, end,
                      blocks_[static_cast<std::size_t>(b)]);
  });
  active_ = 0;
  pairs_ = 0;
  for (const Block& block : blocks()) {
    active_ += static_cast<Index>(block.size());
    for (const std::uint32_t count : block.count) pairs_ += count;
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
