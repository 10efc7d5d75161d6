#include <cmath>

#include "boundaries/exchange.h"
#include "deck/registry.h"

namespace sphgeo {

Schema<Reservoir> Reservoir::schema() {
  Schema<Reservoir> s("reservoir",
                      "keeps the water surface in a region at a level: where it is lower, water at "
                      "zero pressure is inserted");
  s.required("shape", &Reservoir::shape, unit::none,
             "the region in which water is inserted; bounded");
  s.required("level", &Reservoir::level, unit::length, "z of the surface");
  s.check([](Reservoir& r, CheckContext& c) {
    const Aabb box = r.shape->box();
    if (!(box.lo.allFinite() && box.hi.allFinite()))
      return c.error("shape", "the region is unbounded", "intersect it with a box");
    if (box.lo.z() > r.level - c.resolution() || box.hi.z() < r.level)
      c.error("level", "the region does not contain the layer below this level",
              "let its box reach from a spacing below to the level");
  });
  return s;
}

std::vector<Vec3> Reservoir::positions(double spacing, int dimension) const {
  const Aabb box = shape->box();
  std::vector<Vec3> positions;
  // At least a spacing apart: each particle gets its full mass.
  const auto count = [&](int k) {
    return std::max<Index>(
        1, static_cast<Index>(std::floor((box.hi[k] - box.lo[k]) / spacing + 1e-9)));
  };
  const Index nx = count(0), ny = dimension == 2 ? 1 : count(1);
  for (Index y = 0; y < ny; ++y)
    for (Index x = 0; x < nx; ++x) {
      const Vec3 p(box.lo.x() + (static_cast<double>(x) + 0.5) * (box.hi.x() - box.lo.x()) /
                                    static_cast<double>(nx),
                   dimension == 2
                       ? 0
                       : box.lo.y() + (static_cast<double>(y) + 0.5) * (box.hi.y() - box.lo.y()) /
                                          static_cast<double>(ny),
                   level - 0.5 * spacing);
      if (shape->signed_distance(p) < 0) positions.push_back(p);
    }
  return positions;
}

Aabb Reservoir::source_box() const { return shape->box(); }

namespace {
const Register<BoundarySpec, Reservoir> registered_reservoir{"reservoir"};
}
}  // namespace sphgeo
