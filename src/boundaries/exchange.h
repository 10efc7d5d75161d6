#pragma once
// Borders through which particles enter or leave. What they do is done by effects.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// A border that water or soil crosses.
struct ExchangeBoundary : BoundarySpec {
  /// Where particles appear, m; empty for a border through which they only leave.
  virtual Aabb source_box() const { return {}; }
  /// About how many particles enter between two times, s; empty when that cannot be known.
  virtual std::optional<double> expected_particles(double spacing, int dimension, double from,
                                                   double to) const {
    (void)spacing, (void)dimension, (void)from, (void)to;
    return 0.0;
  }
};

/// A flat rectangle (in 2D a line) that emits layers of water with a prescribed velocity, into air
/// or along a wall.
struct Inlet final : ExchangeBoundary {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  std::array<Expression, 3> velocity;
  double share = 1;
  Index seed = 1;
  double from = 0;
  std::optional<double> until;

  /// The axis that the rectangle is across: 0, 1 or 2.
  int axis(int dimension) const;
  /// The velocity at a time, m/s.
  Vec3 velocity_at(double time) const;
  /// The places of one layer, by rows.
  std::vector<Vec3> layer(double spacing, int dimension) const;

  Aabb source_box() const override;
  std::optional<double> expected_particles(double spacing, int dimension, double from,
                                           double to) const override;
  static Schema<Inlet> schema();
};

/// Keeps the surface of the water in a region at a level: where it has sunk, water without pressure
/// is added.
struct Reservoir final : ExchangeBoundary {
  std::shared_ptr<const Shape> shape;
  double level = 0;  ///< z of the surface, m

  /// The places just below the level that water may be added at.
  std::vector<Vec3> places(double spacing, int dimension) const;
  Aabb source_box() const override;
  std::optional<double> expected_particles(double, int, double, double) const override {
    return {};
  }
  static Schema<Reservoir> schema();
};

/// A region in which particles are taken out of the scene.
struct Outlet final : ExchangeBoundary {
  std::shared_ptr<const Shape> shape;
  std::vector<std::string> sets{"water", "soil"};
  static Schema<Outlet> schema();
};

}  // namespace sphgeo
