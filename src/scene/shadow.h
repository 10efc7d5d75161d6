#pragma once
// Is there a wall somewhere in a direction?

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// The shadows that the walls cast along one axis: for every position normal to it, their reach.
class Shadow {
 public:
  /// `box` (m) must hold all points that are added or asked about.
  Shadow(int axis, double spacing, const Aabb& box) : axis_(axis), spacing_(spacing), lo_(box.lo) {
    for (int k = 0; k < 2; ++k) {
      const int a = across(k);
      n_[k] = static_cast<Index>(std::floor((box.hi[a] - box.lo[a]) / spacing)) + 2;
    }
    range_.assign(static_cast<std::size_t>(n_[0] * n_[1]), {none, -none});
  }
  void add(const Vec3& at) {
    const auto [i, j] = place(at, -0.49);
    const auto [i1, j1] = place(at, 0.49);
    for (Index b = j; b <= j1; ++b)
      for (Index a = i; a <= i1; ++a) {
        auto& r = range_[static_cast<std::size_t>(b * n_[0] + a)];
        r = {std::min(r[0], at[axis_]), std::max(r[1], at[axis_])};
      }
  }
  /// Whether a wall lies beyond `at` in the direction.
  bool beyond(const Vec3& at, bool high) const {
    const auto [i, j] = place(at, 0);
    const auto& r = range_[static_cast<std::size_t>(j * n_[0] + i)];
    return high ? r[1] > at[axis_] : r[0] < at[axis_];
  }

 private:
  int across(int k) const { return k == 0 ? (axis_ == 0 ? 1 : 0) : (axis_ == 2 ? 1 : 2); }
  std::array<Index, 2> place(const Vec3& at, double by) const {
    std::array<Index, 2> p;
    for (int k = 0; k < 2; ++k) {
      const int a = across(k);
      const double x = std::floor((at[a] - lo_[a]) / spacing_ + by);
      p[static_cast<std::size_t>(k)] =
          static_cast<Index>(std::clamp(x, 0.0, static_cast<double>(n_[k] - 1)));
    }
    return p;
  }

  static constexpr double none = std::numeric_limits<double>::infinity();
  int axis_;
  double spacing_;
  Vec3 lo_;
  Index n_[2];
  std::vector<std::array<double, 2>> range_;
};

}  // namespace sphgeo
