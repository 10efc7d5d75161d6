#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, HalfSpace> registered_half_space{"half_space"};
}

Schema<HalfSpace> HalfSpace::schema() {
  Schema<HalfSpace> s("half_space",
                      "Everything below a plane. Unbounded: useful inside an intersection.");
  s.required("point", &HalfSpace::point, unit::length, "Any point of the plane.");
  s.optional("normal", &HalfSpace::normal, unit::none, "Outward normal of the solid; any length.");
  s.check([](HalfSpace& h, CheckContext& c) {
    set_scene(h, c);
    if (h.normal.isZero(0))
      c.error("normal", "the normal has no direction",
              h.flat ? "in 2D give its x and z components" : "give a vector such as [0, 0, 1]");
    else h.prepare();
  });
  return s;
}

Aabb HalfSpace::box() const {
  Aabb b = everywhere();
  for (int k = 0; k < 3; ++k) {
    if (unit_[k] == 1.0) b.hi[k] = point[k];
    if (unit_[k] == -1.0) b.lo[k] = point[k];
  }
  return seen(b);
}

}  // namespace sphgeo
