#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Capsule> registered_capsule{"capsule"};
}

Schema<Capsule> Capsule::schema() {
  Schema<Capsule> s("capsule",
                    "A cylinder with round ends: all points within a distance of a segment.");
  s.required("from", &Capsule::from, unit::length, "One end of the segment.");
  s.required("to", &Capsule::to, unit::length, "The other end of the segment.");
  s.required("radius", &Capsule::radius, unit::length, "Greatest distance from the segment.")
      .above(0);
  s.check([](Capsule& b, CheckContext& c) { set_scene(b, c); });
  return s;
}

double Capsule::signed_distance(const Vec3& at) const {
  return segment_distance(at, from, to) - radius;
}

Aabb Capsule::box() const { return seen(box_of_balls(from, radius, to, radius)); }

}  // namespace sphgeo
