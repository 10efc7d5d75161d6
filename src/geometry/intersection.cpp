#include "geometry/csg_parts.h"
#include "geometry/refine.h"

namespace sphgeo {

namespace {
const Register<Shape, Intersection> registered_intersection{"intersection"};
}

Schema<Intersection> Intersection::schema() {
  Schema<Intersection> s("intersection", "The common part of several shapes.");
  s.required("of", &Intersection::of, unit::none, "The shapes to intersect.").items(1);
  s.check([](Intersection& b, CheckContext& c) {
    set_scene(b, c);
    if (b.box().empty()) c.error("of", "the shapes have no point in common");
  });
  return s;
}

double Intersection::bound(const Vec3& at) const {
  double d = -std::numeric_limits<double>::infinity();
  for (const ShapePtr& part : of) d = std::max(d, part->bound(at));
  return d;
}

double Intersection::signed_distance(const Vec3& at) const {
  if (bound(at) > 0.0)
    return refined_distance([this](const Vec3& q) { return bound(q); }, at, -1, flat);
  // Inside, the nearest of all surfaces decides.
  double d = -std::numeric_limits<double>::infinity();
  for (const ShapePtr& part : of) d = std::max(d, part->signed_distance(at));
  return d;
}

Aabb Intersection::box() const {
  Aabb b = everywhere();
  for (const ShapePtr& part : of) {
    const Aabb other = part->box();
    b.lo = b.lo.cwiseMax(other.lo);
    b.hi = b.hi.cwiseMin(other.hi);
  }
  return seen(b);
}

void Intersection::inspect(CheckContext& context) const { inspect_parts(of, context); }

}  // namespace sphgeo
