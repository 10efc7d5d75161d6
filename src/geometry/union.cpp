#include "geometry/csg_parts.h"
#include "geometry/refine.h"

namespace sphgeo {

namespace {
const Register<Shape, Union> registered_union{"union"};
}

Schema<Union> Union::schema() {
  Schema<Union> s("union", "The union of several shapes.");
  s.required("of", &Union::of, unit::none, "The shapes to join.").items(1);
  s.check([](Union& u, CheckContext& c) {
    set_scene(u, c);
    u.boxes = boxes_of(u.of, u.flat);
  });
  return s;
}

double Union::bound(const Vec3& at) const {
  double d = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < of.size(); ++k)
    if (!farther(boxes, k, at, d)) d = std::min(d, of[k]->bound(at));
  return d;
}

double Union::signed_distance(const Vec3& at) const {
  // Outside, the distance is that of the nearest part.
  double d = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < of.size(); ++k)
    if (!farther(boxes, k, at, d)) d = std::min(d, of[k]->signed_distance(at));
  // Parts that touch (but for round-off) leave a seam within the solid where every part says
  // "zero"; lowering the surface slightly makes the seam solid for the search.
  const double hair = 1e-12 * (1.0 + at.cwiseAbs().maxCoeff());
  const bool seam = std::abs(d) < hair && on_inner_seam(*this, at, 1e3 * hair, flat);
  if (d >= 0.0 && !seam) return d;
  return refined_distance([this, hair](const Vec3& q) { return bound(q) - hair; }, at, 1, flat);
}

Aabb Union::box() const {
  Aabb b;
  for (const ShapePtr& part : of) b.extend(part->box());
  return seen(b);
}

void Union::inspect(CheckContext& context) const { inspect_parts(of, context); }

}  // namespace sphgeo
