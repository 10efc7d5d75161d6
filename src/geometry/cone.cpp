#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Cone> registered_cone{"cone"};
}

Schema<Cone> Cone::schema() {
  Schema<Cone> s("cone", "A cone, or a frustum when both radii are given; a trapezoid in 2D.");
  s.required("from", &Cone::from, unit::length, "The center of the base.");
  s.required("to", &Cone::to, unit::length, "The tip, or the center of the other end.");
  s.required("radius_from", &Cone::radius_from, unit::length, "Radius at `from`.").at_least(0);
  s.optional("radius_to", &Cone::radius_to, unit::length, "Radius at `to`; 0 is a tip.")
      .at_least(0);
  s.check([](Cone& b, CheckContext& c) {
    set_scene(b, c);
    if (b.from == b.to)
      c.error("to", "the ends of the cone coincide",
              b.flat ? "in 2D the axis of a cone must lie in the x-z plane"
                     : "move `to` away from `from`");
    if (b.radius_from == 0 && b.radius_to == 0)
      c.error("radius_from", "both radii of the cone are 0", "give at least one end a radius");
  });
  return s;
}

double Cone::signed_distance(const Vec3& at) const {
  return frustum_distance(at, from, to, radius_from, radius_to);
}

Aabb Cone::box() const { return seen(box_of_discs(from, radius_from, to, radius_to)); }

}  // namespace sphgeo
