#pragma once
// Boundaries through which particles enter or leave. Effects insert and remove the particles.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// An open boundary, crossed by water or soil.
struct ExchangeBoundary : BoundarySpec {
  /// The box in which particles are inserted, m; empty for a boundary that only removes them.
  virtual Aabb source_box() const { return {}; }
  /// Approximate number of particles that enter between two times, s; empty when it is unknown.
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

  /// The axis normal to the rectangle: 0, 1 or 2.
  int axis(int dimension) const;
  /// The velocity at a time, m/s.
  Vec3 velocity_at(double time) const;
  /// The positions of one layer, by rows.
  std::vector<Vec3> layer(double spacing, int dimension) const;

  Aabb source_box() const override;
  std::optional<double> expected_particles(double spacing, int dimension, double from,
                                           double to) const override;
  static Schema<Inlet> schema();
};

/// Keeps the water surface in a region at a level: where it is lower, water at zero pressure is
/// inserted.
struct Reservoir final : ExchangeBoundary {
  std::shared_ptr<const Shape> shape;
  double level = 0;  ///< z of the surface, m

  /// The positions just below the level at which water may be inserted.
  std::vector<Vec3> positions(double spacing, int dimension) const;
  Aabb source_box() const override;
  std::optional<double> expected_particles(double, int, double, double) const override {
    return {};
  }
  static Schema<Reservoir> schema();
};

/// A region in which particles are removed.
struct Outlet final : ExchangeBoundary {
  std::shared_ptr<const Shape> shape;
  std::vector<std::string> sets{"water", "soil"};
  static Schema<Outlet> schema();
};

}  // namespace sphgeo
