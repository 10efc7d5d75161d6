#include "boundaries/boundary.h"
#include "core/parallel.h"
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
    // Only as deep as the kernel support: particles farther inside have no neighbors in fluids.
    const std::vector<Vec3> at =
        fill_layers(*shape, p.spacing, p.dimension, p.thickness, LayerSide::inside, p.clip);
    std::vector<WallPoint> wall(at.size());
    parallel_for(static_cast<Index>(at.size()), [&](Index i) {
      const auto k = static_cast<std::size_t>(i);
      wall[k] = {at[k], outward_normal(*shape, at[k], 0.5 * p.spacing, p.dimension)};
    });
    return wall;
  }
  std::shared_ptr<const Shape> solid(const Placement&) const override { return shape; }
};

const Register<BoundarySpec, Wall> registered_wall{"wall"};

}  // namespace
}  // namespace sphgeo
