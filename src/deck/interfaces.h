#pragma once
// The bases of everything a deck selects by `type:`. They live here because the Model holds them;
// what they compute is declared in the rooms above.

#include <optional>
#include <string>

#include "core/types.h"
#include "deck/check_context.h"

namespace sphgeo {

template <class P>
class Schema;

/// A region of space. Dimension-free: in 2D it is evaluated at y = 0.
struct Shape {
  static constexpr const char* kind = "shape";
  std::string type;  ///< the deck's `type:`

  virtual ~Shape() = default;
  /// Distance to the surface (m), negative inside.
  virtual double signed_distance(const Vec3& at) const = 0;
  /// Right sign, and no more than the distance: enough to ask "inside or outside". For composed
  /// shapes it is faster than the distance itself.
  virtual double bound(const Vec3& at) const { return signed_distance(at); }
  /// Whether bound() may be less than the distance.
  virtual bool composed() const { return false; }
  /// Whether every face lies along the axes, so that a lattice fits.
  virtual bool along_axes() const { return false; }
  /// A box around the shape (m); components may be infinite.
  virtual Aabb box() const = 0;
  /// Reports defects of the geometry itself, such as an open surface.
  virtual void inspect(CheckContext&) const {}
};

/// A material as the deck gives it. Concrete materials add their parameters.
struct MaterialSpec {
  static constexpr const char* kind = "material";
  std::string type;
  std::string name;

  virtual ~MaterialSpec() = default;
  /// The phase its particles belong to: "water", "soil" or "solid".
  virtual std::string phase() const = 0;
  static Schema<MaterialSpec> common();
};

/// A boundary as the deck gives it.
struct BoundarySpec {
  static constexpr const char* kind = "boundary";
  std::string type;
  std::string name;

  virtual ~BoundarySpec() = default;
  static Schema<BoundarySpec> common();
};

/// A probe as the deck gives it.
struct ProbeSpec {
  static constexpr const char* kind = "probe";
  std::string type;
  std::string name;
  std::optional<double> every;  ///< interval (s); empty: end_time / 500

  virtual ~ProbeSpec() = default;
  static Schema<ProbeSpec> common();
};

}  // namespace sphgeo
