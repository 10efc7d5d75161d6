#include "geometry/csg_parts.h"
#include "geometry/refine.h"

namespace sphgeo {

namespace {
const Register<Shape, Union> registered{"union"};
}

Schema<Union> Union::schema() {
  Schema<Union> s("union", "All points of any of several shapes.");
  s.required("of", &Union::of, unit::none, "The shapes to join.").items(1);
  s.check([](Union& u, CheckContext& c) { set_scene(u, c); });
  return s;
}

double Union::bound(const Vec3& at) const {
  double d = std::numeric_limits<double>::infinity();
  for (const ShapePtr& part : of) d = std::min(d, distance_bound(*part, at));
  return d;
}

double Union::signed_distance(const Vec3& at) const {
  // Outside, the nearest part decides, and each part knows its own distance.
  double d = std::numeric_limits<double>::infinity();
  for (const ShapePtr& part : of) d = std::min(d, part->signed_distance(at));
  if (d >= 0.0) return d;
  return refined_distance([this](const Vec3& q) { return bound(q); }, at, 1, flat);
}

Aabb Union::box() const {
  Aabb b;
  for (const ShapePtr& part : of) b.extend(part->box());
  return seen(b);
}

void Union::inspect(CheckContext& context) const { inspect_parts(of, context); }

}  // namespace sphgeo
