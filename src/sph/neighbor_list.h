#pragma once
// Neighbor lists: for each particle of a target set the particles of a source set within a radius.

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.h"
#include "core/parallel.h"
#include "core/types.h"
#include "sph/cell_grid.h"

namespace sphgeo {

/// Whether a list pairs a set with itself or with another set.
enum class Pairing {
  within,  ///< one set: no self-pairs; every particle is visited, also isolated ones
  across   ///< two sets: only targets that have a neighbor are visited
};

/// Flat lists of neighbors of a target set in a source set, exact at the time of building, in cell
/// order of the source. Both directions agree: j is a neighbor of i if and only if i is one of j,
/// also between lists built for the two directions of a pair of sets with the same radius and
/// frame. Neighbors are stored as offsets of records, 8 j, and every target's list is filled up to
/// `padding` entries with the null record n.
class NeighborList {
 public:
  /// Entries of each target's list are a multiple of this.
  static constexpr int padding = 16;

  /// Targets [256 b, 256 b + 256) and their lists.
  struct Block {
    AlignedVector<std::uint32_t> targets;  ///< walked targets, rising
    AlignedVector<std::uint32_t> begin;    ///< first entry of each walked target, and the end
    AlignedVector<std::uint32_t> count;    ///< neighbors of each walked target, without padding
    AlignedVector<std::uint32_t> entries;  ///< 8 j; may be longer than the lists in use

    std::size_t size() const { return targets.size(); }
  };

  /// Finds all sources nearer than `radius` [m] to each target. With Pairing::within, `targets` are
  /// the particles of the grid themselves. Throws Error for sets too large for 32-bit offsets.
  template <int Dim>
  void build(std::span<const Vec<Dim>> targets, const CellGrid<Dim>& sources, double radius,
             Pairing pairing);

  /// Keeps the pairs (i, j) for which keep(i, j) holds, asked from all threads; targets that have
  /// none left are walked as before.
  template <class F>
  void filter(F&& keep);

  /// Blocks in the order of targets; those without walked targets are left out of no index.
  std::span<const Block> blocks() const { return {blocks_.data(), block_count_}; }

  Index target_count() const { return targets_; }  ///< size of the target set
  Index source_count() const { return sources_; }  ///< size of the source set
  Index active() const { return count_.active; }   ///< walked targets
  Index pairs() const { return count_.pairs; }     ///< directed pairs, without padding
  std::size_t bytes() const;                       ///< memory in use

  /// Calls f(i, j) for every pair, one thread, in order of i: for tests and rare uses.
  template <class F>
  void for_each_pair(F&& f) const {
    for (const Block& block : blocks())
      for (std::size_t k = 0; k < block.size(); ++k)
        for (std::uint32_t e = 0; e < block.count[k]; ++e)
          f(static_cast<Index>(block.targets[k]),
            static_cast<Index>(block.entries[block.begin[k] + e] / 8));
  }

 private:
  struct Count {
    Index active = 0, pairs = 0;
  };
  void count_pairs();

  std::vector<Block> blocks_;
  std::size_t block_count_ = 0;
  Index targets_ = 0;
  Index sources_ = 0;
  Count count_;
};

template <class F>
void NeighborList::filter(F&& keep) {
  const auto null_offset = static_cast<std::uint32_t>(sources_ * 8);
  parallel_blocks(static_cast<Index>(block_count_), 1, [&](Index b, Index, Index) {
    Block& block = blocks_[static_cast<std::size_t>(b)];
    for (std::size_t k = 0; k < block.size(); ++k) {
      std::uint32_t* entry = block.entries.data() + block.begin[k];
      std::uint32_t kept = 0;
      for (std::uint32_t e = 0; e < block.count[k]; ++e)
        if (keep(static_cast<Index>(block.targets[k]), static_cast<Index>(entry[e] / 8)))
          entry[kept++] = entry[e];
      for (std::uint32_t e = kept; e < block.count[k]; ++e) entry[e] = null_offset;
      block.count[k] = kept;
    }
  });
  count_pairs();
}

}  // namespace sphgeo
