#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Ellipsoid> registered_ellipsoid{"ellipsoid"};
}

Schema<Ellipsoid> Ellipsoid::schema() {
  Schema<Ellipsoid> s("ellipsoid",
                      "An ellipsoid with its axes along x, y and z; an ellipse in 2D. Use "
                      "`transform` to rotate it.");
  s.required("center", &Ellipsoid::center, unit::length, "The center.");
  s.required("semi_axes", &Ellipsoid::semi_axes, unit::length, "Half the width along each axis.");
  s.check([](Ellipsoid& e, CheckContext& c) {
    set_scene(e, c);
    if (e.semi_axes.x() <= 0 || e.semi_axes.z() <= 0 || (!e.flat && e.semi_axes.y() <= 0))
      c.error("semi_axes", "every semi-axis must be greater than 0");
  });
  return s;
}

double Ellipsoid::signed_distance(const Vec3& at) const {
  const Vec3 p = at - center;
  if (flat) return ellipse_distance({p.x(), p.z()}, {semi_axes.x(), semi_axes.z()});
  return ellipsoid_distance(p, semi_axes);
}

Aabb Ellipsoid::box() const { return seen({center - semi_axes, center + semi_axes}); }

}  // namespace sphgeo
