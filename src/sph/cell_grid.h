#pragma once
// A grid of cells over one particle set: sorts the particles and finds those near a point.

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.h"
#include "core/types.h"
#include "sph/fixed_point.h"

namespace sphgeo {

/// Particles of one set in the order of cells (row-major, x fastest; by index within a cell). It
/// holds its own copy of the positions, in fixed point, so it answers for the moment of `build`.
template <int Dim>
class CellGrid {
 public:
  /// Sorts `r` [m] into cells about as large as `reach` [m], the largest radius of later searches
  /// (any other radius works too, only slower). Cells grow if the box would need too many of them.
  /// Throws Error for more than 2^29 - 1 particles.
  void build(std::span<const Vec<Dim>> r, const FixedPoint<Dim>& frame, double reach);

  /// Particle at each place of the cell order: the permutation that sorts the set.
  std::span<const std::uint32_t> order() const { return {order_.data(), size_}; }

  /// Says that the set has been reordered by order(): place k now holds particle k. Lists are built
  /// fastest from sorted sets.
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
    for_each_row(x, static_cast<std::int64_t>(limit) + 1, [&](std::size_t begin, std::size_t end) {
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

  /// Calls f(begin, end) for ranges of places (see place_*) that hold all particles whose
  /// coordinates differ from x by at most `reach` quanta; in cell order.
  template <class F>
  void for_each_row(const std::int32_t* x, std::int64_t reach, F&& f) const {
    std::int64_t lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0};
    for (int d = 0; d < Dim; ++d) {
      lo[d] = cell(x[d] - reach, d);
      hi[d] = cell(x[d] + reach, d);
    }
    for (std::int64_t c2 = lo[2]; c2 <= hi[2]; ++c2) {
      for (std::int64_t c1 = lo[1]; c1 <= hi[1]; ++c1) {
        const std::int64_t row = (c2 * count_[1] + c1) * count_[0];
        const std::size_t begin = start_[static_cast<std::size_t>(row + lo[0])];
        const std::size_t end = start_[static_cast<std::size_t>(row + hi[0] + 1)];
        if (begin < end) f(begin, end);
      }
    }
  }

  /// Coordinate d of the particles by place, in quanta; readable for 16 places past the end.
  const std::int32_t* place_coordinate(int d) const { return coordinate_[d].data(); }
  /// Particle by place; readable for 16 places past the end.
  const std::uint32_t* place_particle() const { return order_.data(); }

 private:
  // Monotone in x, and clamped: the cells of an interval hold all particles of the interval.
  std::int64_t cell(std::int64_t x, int d) const {
    const std::int64_t offset = x - lowest_[d];
    if (offset <= 0) return 0;
    const auto c = static_cast<std::int64_t>(static_cast<double>(offset) * per_cell_[d]);
    return c < count_[d] ? c : count_[d] - 1;
  }

  void choose_cells(const std::int32_t* lo, const std::int32_t* hi, double reach);
  void sort();

  FixedPoint<Dim> frame_;
  std::size_t size_ = 0;
  std::int64_t lowest_[3] = {0, 0, 0};  // corner of the box, in quanta
  std::int64_t count_[3] = {1, 1, 1};   // cells along each axis
  double per_cell_[3] = {0, 0, 0};      // 1 / edge of a cell, in quanta
  std::vector<std::uint32_t> start_{0, 0};
  AlignedVector<std::uint32_t> order_;
  AlignedVector<std::int32_t> coordinate_[Dim];
  AlignedVector<std::uint32_t> key_;         // scratch of build
  AlignedVector<std::int32_t> unsorted_[Dim];
};

extern template class CellGrid<1>;
extern template class CellGrid<2>;
extern template class CellGrid<3>;

}  // namespace sphgeo
