#pragma once
// Volume fraction available to water at a position: the porosity of the soil there, or 1.

#include <memory>
#include <string>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// The signed distance (m) where it may be below `reach`, else a bound of it: of the right sign, at
/// least reach.
double distance_near(const Shape& shape, const Vec3& at, double reach);

/// Target water fraction phi(x) = 1 - n^s(x) of a deck (section 3.3): n^s from the bodies of soil,
/// 1 outside of them. Where bodies of soil overlap, which a deck may not, the first one counts.
class WaterTarget {
 public:
  explicit WaterTarget(const Model& model);

  /// One body of soil: its region, and its volume fraction or porosity at t = 0.
  struct Skeleton {
    std::size_t body;  ///< of the deck
    std::shared_ptr<const Shape> shape;
    Aabb box;
    Expression amount;
    bool porosity = false;  ///< amount is 1 - n^s
    double solid(const Vec3& at) const { return porosity ? 1 - amount(at, 0) : amount(at, 0); }
  };
  const std::vector<Skeleton>& soils() const { return soils_; }

  /// Water fraction at a point, not above 1; NaN where a formula is none.
  double fraction(const Vec3& at) const;

  /// The number of the soil that holds a point (-1: none), and a distance (m) over which this
  /// surely stays so.
  struct Where {
    int soil = -1;
    double holds = 0;
  };
  Where locate(const Vec3& at) const;
  /// Water fraction at a point within the soil of that number; 1 for -1.
  double fraction_in(int soil, const Vec3& at) const {
    return soil < 0 ? 1 : 1 - soils_[static_cast<std::size_t>(soil)].solid(at);
  }

  /// Mean fraction of a small cube (square) around a point: the surfaces of soils cut it along
  /// planes.
  double mean_fraction(const Vec3& at, double edge) const;

  /// Below this the porosity is too small for a filling with particles.
  static constexpr double smallest = 0.05;

 private:
  std::vector<Skeleton> soils_;
};

}  // namespace sphgeo
