#include "boundaries/boundary.h"
#include "deck/registry.h"
#include "geometry/fill.h"
#include "geometry/normal.h"

namespace sphgeo {
namespace {

/// A solid of any shape that does not deform: a gate, a slope, a piston, a sill.
struct Wall final : WallBoundary {
  std::shared_ptr<const Shape> shape;

  static Schema<Wall> schema() {
    Schema<Wall> s("wall", "a rigid solid of any shape, at rest or with a prescribed motion");
    s.required("shape", &Wall::shape, unit::none, "the solid");
    declare_wall_keys(s);
    return s;
  }

  std::vector<WallPoint> points(const Placement& p) const override {
    std::vector<WallPoint> wall;
    // Only as deep as the kernel support: particles farther inside have no neighbors in fluids.
    for (const Vec3& x :
         fill_layers(*shape, p.spacing, p.dimension, p.thickness, LayerSide::inside, p.clip))
      wall.push_back({x, outward_normal(*shape, x, 0.5 * p.spacing, p.dimension)});
    return wall;
  }
  std::shared_ptr<const Shape> solid(const Placement&) const override { return shape; }
};

const Register<BoundarySpec, Wall> registered_wall{"wall"};

}  // namespace
}  // namespace sphgeo
