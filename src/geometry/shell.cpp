#include <cmath>

#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Shell> registered_shell{"shell"};
}

Schema<Shell> Shell::schema() {
  Schema<Shell> s("shell",
                  "A hollow body: a shell of uniform thickness along the surface of another shape. "
                  "Outer edges of an outside shell are rounded.");
  s.required("of", &Shell::of, unit::none, "The shape whose surface defines the shell.");
  s.required("thickness", &Shell::thickness, unit::length, "Thickness of the shell.").above(0);
  s.optional("side", &Shell::side, unit::none,
             "Position of the shell: inside the shape, outside of it, or half on each side.")
      .choices({"inside", "outside", "centered"});
  s.check([](Shell& b, CheckContext& c) {
    set_scene(b, c);
    if (c.resolution() > 0.0 && b.thickness < c.resolution() * (1.0 - 1e-9))
      c.warning("thickness", "the shell is thinner than the particle spacing",
                "make it at least one spacing thick, better three");
  });
  return s;
}

double Shell::offset() const {
  return side == "inside" ? -0.5 * thickness : side == "outside" ? 0.5 * thickness : 0.0;
}

double Shell::signed_distance(const Vec3& at) const {
  return std::abs(of->signed_distance(at) - offset()) - 0.5 * thickness;
}

Aabb Shell::box() const { return seen(of->box().grown(offset() + 0.5 * thickness)); }

void Shell::inspect(CheckContext& context) const {
  CheckContext part = context.inside("of");
  of->inspect(part);
}

}  // namespace sphgeo
