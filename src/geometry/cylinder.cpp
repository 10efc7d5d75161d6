#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Cylinder> registered_cylinder{"cylinder"};
}

Schema<Cylinder> Cylinder::schema() {
  Schema<Cylinder> s(
      "cylinder",
      "A round cylinder with flat ends. In 2D a disc when its axis is along y (the ends "
      "then coincide in the plane), else a rectangle.");
  s.required("from", &Cylinder::from, unit::length, "The center of one end.");
  s.required("to", &Cylinder::to, unit::length, "The center of the other end.");
  s.required("radius", &Cylinder::radius, unit::length, "The radius.").above(0);
  s.check([](Cylinder& b, CheckContext& c) {
    set_scene(b, c);
    if (!b.flat && b.from == b.to)
      c.error("to", "the ends of the cylinder coincide", "move `to` away from `from`");
  });
  return s;
}

double Cylinder::signed_distance(const Vec3& at) const {
  if (from == to) return (at - from).norm() - radius;
  return frustum_distance(at, from, to, radius, radius);
}

Aabb Cylinder::box() const {
  if (from == to) return seen(box_of_balls(from, radius, from, radius));
  return seen(box_of_discs(from, radius, to, radius));
}

}  // namespace sphgeo
