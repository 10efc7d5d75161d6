#include <Eigen/Geometry>

#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Transform> registered_transform{"transform"};
}

Schema<Transform> Transform::schema() {
  Schema<Transform> s("transform",
                      "Another shape, scaled and rotated about a point and then moved.");
  s.required("of", &Transform::of, unit::none, "The shape to transform.");
  s.optional("scale", &Transform::scale, unit::none, "Factor on all lengths, about `about`.")
      .above(0);
  s.optional("rotate", &Transform::rotate, unit::angle, "Angle, right-handed about `axis`.");
  s.optional("axis", &Transform::axis, unit::none,
             "Direction of the axis of rotation; the default [0, -1, 0] turns x towards z, "
             "counter-clockwise in the x-z plane. In 2D only the sign of y counts.")
      .keep_y();
  s.optional("about", &Transform::about, unit::length, "Fixed point of scaling and rotation.");
  s.optional("translate", &Transform::translate, unit::length, "Displacement, applied last.");
  s.check([](Transform& t, CheckContext& c) {
    set_scene(t, c);
    if (t.flat && t.rotate != 0.0 && (t.axis.x() != 0.0 || t.axis.z() != 0.0))
      return c.error("axis", "in 2D the axis of rotation is along y",
                     "write [0, -1, 0] (counter-clockwise) or leave it out");
    if (t.axis.isZero(0)) return c.error("axis", "the axis has no direction");
    t.prepare();
  });
  return s;
}

void Transform::prepare() {
  turn_ = rotate == 0.0 ? Mat3(Mat3::Identity())
                        : Eigen::AngleAxisd(rotate, direction_of(axis)).toRotationMatrix();
}

bool Transform::along_axes() const {
  // A quarter turn maps axes to axes: one component of each column is 1 or -1.
  return of->along_axes() && (turn_.cwiseAbs().colwise().maxCoeff().array() > 1 - 1e-12).all();
}

Aabb Transform::box() const {
  const Aabb b = of->box();
  Aabb out;
  for (int k = 0; k < 3; ++k) {
    // Interval arithmetic, which keeps infinite bounds apart: 0 * inf does not count.
    double lo = about[k] + translate[k], hi = lo;
    for (int j = 0; j < 3; ++j) {
      const double f = scale * turn_(k, j);
      if (std::abs(turn_(k, j)) < 1e-15) continue;
      const double a = f * (b.lo[j] - about[j]), c = f * (b.hi[j] - about[j]);
      lo += std::min(a, c);
      hi += std::max(a, c);
    }
    out.lo[k] = lo;
    out.hi[k] = hi;
  }
  return seen(out);
}

void Transform::inspect(CheckContext& context) const {
  CheckContext part = context.inside("of");
  of->inspect(part);
}

}  // namespace sphgeo
