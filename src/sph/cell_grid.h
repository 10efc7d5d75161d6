#pragma once
// A grid of cells over one particle set: sorts the particles and finds those near a point.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/aligned.h"
#include "core/types.h"
#include "sph/fixed_point.h"

namespace sphgeo {

/// Particles of one set in the order of cells (row-major, x fastest), and of their ids within a
/// cell. The cells are those of the frame: their edges and corners depend on the frame and on the
/// reach alone, never on which particles the set holds, so two particles of one set stand in the
/// same order in any part of it. The grid holds its own copy of the positions, in fixed point, so
/// it describes the moment of `build`.
template <int Dim>
class CellGrid {
 public:
  /// Sorts `r` [m] into cells about as large as `reach` [m], the largest radius of later searches
  /// (any other radius works too, only slower). `ids` are those of the particles; without any,
  /// their indices take their place. Throws Error for more than 2^29 - 2 particles.
  void build(std::span<const Vec<Dim>> r, const FixedPoint<Dim>& frame, double reach,
             std::span<const Id> ids = {});

  /// Particle at each position of the cell order: the permutation that sorts the set.
  std::span<const std::uint32_t> order() const { return {order_.data(), size_}; }

  /// States that the set has been reordered by order(): position k now holds particle k. Lists are
  /// built fastest from sorted sets.
  void set_sorted();

  Index size() const { return static_cast<Index>(size_); }
  const FixedPoint<Dim>& frame() const { return frame_; }
  /// Memory in use [bytes].
  std::size_t bytes() const;

  /// Calls f(j, r2) for every particle nearer to `at` than `radius` [m]; r2 is the squared distance
  /// [m^2], exact up to the rounding of positions to FixedPoint.
  template <class F>
  void for_each_in_reach(const Vec<Dim>& at, double radius, F&& f) const {
    std::int32_t x[Dim];
    for (int d = 0; d < Dim; ++d) x[d] = frame_.to_fixed(at[d], d);
    const double limit = radius * frame_.per_quantum;
    for_each_row(x, x, limit, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        double r2 = 0.0;
        for (int d = 0; d < Dim; ++d) {
          const double dx = static_cast<double>(x[d] - coordinate_[d][k]);
          r2 += dx * dx;
        }
        if (r2 < limit * limit)
          f(static_cast<Index>(order_[k]), r2 * frame_.quantum * frame_.quantum);
      }
    });
  }

  // ---- for neighbor lists ----

  /// Calls f(begin, end) for ranges of slots (see slot_*) that hold all particles nearer than
  /// `reach` to the box from lo to hi, all in quanta; in cell order. A range is a row of cells, cut
  /// where no point of the box can reach.
  template <class F>
  void for_each_row(const std::int32_t* lo, const std::int32_t* hi, double reach, F&& f) const {
    // A margin of one quantum: rounding of cell edges cannot lose a particle.
    const double all = reach + 1.0;
    std::int64_t first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
    for (int d = 1; d < Dim; ++d) {
      first[d] = cell(lo[d] - all, d);
      last[d] = cell(hi[d] + all, d);
    }
    for (std::int64_t c2 = first[2]; c2 <= last[2]; ++c2) {
      const double left2 = all * all - (Dim > 2 ? gap2(lo, hi, c2, 2) : 0.0);
      for (std::int64_t c1 = first[1]; c1 <= last[1]; ++c1) {
        const double half2 = left2 - (Dim > 1 ? gap2(lo, hi, c1, 1) : 0.0);
        if (half2 < 0.0) continue;
        const double half = std::sqrt(half2) + 1.0;
        const std::int64_t row = (c2 * count_[1] + c1) * count_[0];
        const std::size_t begin = first_slot(row + cell(lo[0] - half, 0));
        const std::size_t end = first_slot(row + cell(hi[0] + half, 0) + 1);
        if (begin < end) f(begin, end);
      }
    }
  }

  /// Coordinate d of the particles by slot of the sorted order, in quanta; readable for 16 slots
  /// past the end.
  const std::int32_t* slot_coordinate(int d) const { return coordinate_[d].data(); }
  /// Particle by slot; readable for 16 slots past the end.
  const std::uint32_t* slot_particle() const { return order_.data(); }

 private:
  // Number of a cell along one axis, counted from the first that the set occupies. Monotone in x,
  // and clamped: the cells of an interval hold all particles of the interval.
  std::int64_t cell(double x, int d) const {
    const double c = (x - FixedPoint<Dim>::lowest) * per_edge_[d];
    return static_cast<std::int64_t>(std::clamp(c, first_[d], last_[d])) -
           static_cast<std::int64_t>(first_[d]);
  }

  // Number of the cell of a point, row-major in the box of cells that the set occupies.
  std::int64_t key(const std::int32_t* x) const {
    std::int64_t k = 0;
    for (int d = Dim - 1; d >= 0; --d) k = k * count_[d] + cell(x[d], d);
    return k;
  }

  // Slot of the first particle in this cell or in a later one.
  std::size_t first_slot(std::int64_t cell_key) const {
    return shift_ == 0 ? start_[static_cast<std::size_t>(cell_key)] : search_slot(cell_key);
  }

  // Squared distance along axis d from a box to cell c; 0 where they overlap, a little less than
  // true at most.
  double gap2(const std::int32_t* lo, const std::int32_t* hi, std::int64_t c, int d) const {
    const double begin = FixedPoint<Dim>::lowest + (first_[d] + static_cast<double>(c)) * edge_[d];
    const double gap = std::max({begin - hi[d] - 1.0, lo[d] - begin - edge_[d] - 1.0, 0.0});
    return gap * gap;
  }

  void choose_cells(const std::int32_t* lo, const std::int32_t* hi, double reach);
  void fill_buckets();
  void sort_buckets(std::span<const Id> ids);
  std::size_t search_slot(std::int64_t cell_key) const;

  FixedPoint<Dim> frame_;
  std::size_t size_ = 0;
  double edge_[3] = {1, 1, 1};         // edge of a cell, in quanta
  double per_edge_[3] = {1, 1, 1};     // 1 / edge
  double first_[3] = {0, 0, 0};        // the cells that the set occupies, along each axis
  double last_[3] = {0, 0, 0};         // counted from the lowest point of the frame
  std::int64_t count_[3] = {1, 1, 1};  // last - first + 1
  // The table of the first slot of each bucket, which is 2^shift cells in a row; and the end,
  // twice.
  int shift_ = 0;
  AlignedVector<std::uint32_t> start_;
  AlignedVector<std::uint32_t> order_;
  AlignedVector<std::int32_t> coordinate_[Dim];
  AlignedVector<std::int32_t> unsorted_[Dim];  // scratch of build
};

extern template class CellGrid<1>;
extern template class CellGrid<2>;
extern template class CellGrid<3>;

}  // namespace sphgeo
