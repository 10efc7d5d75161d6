#include "geometry/csg_parts.h"
#include "geometry/refine.h"

namespace sphgeo {

namespace {
const Register<Shape, Difference> registered_difference{"difference"};
}

Schema<Difference> Difference::schema() {
  Schema<Difference> s("difference", "The first shape without all the others.");
  s.required("of", &Difference::of, unit::none, "The first shape, then those to subtract.")
      .items(2);
  s.check([](Difference& d, CheckContext& c) {
    set_scene(d, c);
    d.boxes = boxes_of(d.of, d.flat);
  });
  return s;
}

double Difference::bound(const Vec3& at) const {
  double d = of.front()->bound(at);
  for (std::size_t k = 1; k < of.size(); ++k)
    if (!farther(boxes, k, at, -d)) d = std::max(d, -of[k]->bound(at));
  return d;
}

double Difference::signed_distance(const Vec3& at) const {
  if (bound(at) > 0.0)
    return refined_distance([this](const Vec3& q) { return bound(q); }, at, -1, flat);
  double d = of.front()->signed_distance(at);
  for (std::size_t k = 1; k < of.size(); ++k)
    if (!farther(boxes, k, at, -d)) d = std::max(d, -of[k]->signed_distance(at));
  return d;
}

Aabb Difference::box() const { return seen(of.front()->box()); }

void Difference::inspect(CheckContext& context) const { inspect_parts(of, context); }

}  // namespace sphgeo
