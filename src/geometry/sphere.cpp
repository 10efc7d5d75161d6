#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Sphere> registered_sphere{"sphere"};
}

Schema<Sphere> Sphere::schema() {
  Schema<Sphere> s("sphere", "A ball; a disc in 2D.");
  s.required("center", &Sphere::center, unit::length, "The center.");
  s.required("radius", &Sphere::radius, unit::length, "The radius.").above(0);
  s.check([](Sphere& b, CheckContext& c) { set_scene(b, c); });
  return s;
}

Aabb Sphere::box() const { return seen(box_of_balls(center, radius, center, radius)); }

}  // namespace sphgeo
