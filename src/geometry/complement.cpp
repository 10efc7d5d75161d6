#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Complement> registered_complement{"complement"};
}

Schema<Complement> Complement::schema() {
  Schema<Complement> s(
      "complement", "Everything outside another shape. Unbounded: useful inside an intersection.");
  s.required("of", &Complement::of, unit::none, "The shape to exclude.");
  s.check([](Complement& b, CheckContext& c) { set_scene(b, c); });
  return s;
}

Aabb Complement::box() const { return seen(everywhere()); }

void Complement::inspect(CheckContext& context) const {
  CheckContext part = context.inside("of");
  of->inspect(part);
}

}  // namespace sphgeo
