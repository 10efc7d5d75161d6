#pragma once
// Boundaries made of wall particles, fixed or moved in a prescribed way.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "deck/interfaces.h"
#include "deck/motion.h"
#include "deck/schema.h"
#include "geometry/fill.h"

namespace sphgeo {

/// What a boundary needs to place its particles.
struct Placement {
  double spacing;    ///< dp, m
  double thickness;  ///< wall thickness that fills every kernel support, m
  int dimension;
  Aabb clip{};  ///< region of interest for solids without end; empty: none
};

/// One wall particle: position and outward unit normal of the solid (towards the fluid).
struct WallPoint {
  Vec3 position;
  Vec3 normal;
  bool corner = false;  ///< in a concave corner of two walls, see mark_corners
};

/// An open side of a boundary, closed by points one spacing apart.
struct OpenFace {
  std::string name;
  int axis;   ///< normal to it
  bool high;  ///< on the side of larger coordinates
  std::vector<Vec3> points;
};

/// Boundary condition for the tangential velocity of the water.
enum class Slip { no_slip, free_slip };

/// Base of all boundaries that are made of wall particles (paper 3.2.3, last paragraph).
struct WallBoundary : BoundarySpec {
  std::string slip = "no_slip";
  std::optional<Motion> motion;

  /// The wall particles at t = 0, in a fixed order.
  virtual std::vector<WallPoint> points(const Placement&) const = 0;
  /// Their approximate number, without placing them; not finite when the solid is unbounded.
  virtual double expected_points(const Placement& p) const {
    const auto shape = solid(p);
    return shape ? estimate_layers(*shape, p.spacing, p.dimension, p.thickness, LayerSide::inside,
                                   p.clip)
                 : 0.0;
  }
  /// The solid as a shape, for checks and pictures; null when it has none.
  virtual std::shared_ptr<const Shape> solid(const Placement&) const = 0;
  /// The sides that are open on purpose, at t = 0; for checks.
  virtual std::vector<OpenFace> open_faces(const Placement&) const { return {}; }

  Slip slip_kind() const { return slip == "no_slip" ? Slip::no_slip : Slip::free_slip; }
};

/// Declares the keys that all wall boundaries share.
template <class B>
void declare_wall_keys(Schema<B>& s) {
  s.optional("slip", &B::slip, unit::none, "no_slip or free_slip condition for the water")
      .choices({"no_slip", "free_slip"});
  s.optional("motion", &B::motion, unit::none, "prescribed motion; without one it is at rest");
}

}  // namespace sphgeo
