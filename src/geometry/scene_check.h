#pragma once
// What the check rules of the shapes share.

#include <exception>

#include "geometry/shapes.h"

namespace sphgeo {

/// Sets whether the scene is two-dimensional.
inline void set_scene(SceneShape& shape, const CheckContext& context) {
  shape.flat = context.dimension() == 2;
}

/// Box of the balls of radius r_a around a and r_b around b.
inline Aabb box_of_balls(const Vec3& a, double r_a, const Vec3& b, double r_b) {
  Aabb box{a.array() - r_a, a.array() + r_a};
  box.extend(Aabb{b.array() - r_b, b.array() + r_b});
  return box;
}

/// Box of two discs with the normal b - a: radius r_a around a and r_b around b.
inline Aabb box_of_discs(const Vec3& a, double r_a, const Vec3& b, double r_b) {
  const Vec3 n = (b - a).normalized();
  const Vec3 reach = (1.0 - n.array().square()).max(0.0).sqrt();
  Aabb box{a - r_a * reach, a + r_a * reach};
  box.extend(Aabb{b - r_b * reach, b + r_b * reach});
  return box;
}

/// A box without bounds.
inline Aabb everywhere() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(-inf), Vec3::Constant(inf)};
}

/// Runs a shape's prepare() and turns what it throws into a finding about `key`.
template <class S>
void prepare_or_report(S& shape, CheckContext& context, const char* key) {
  try {
    shape.prepare();
  } catch (const std::exception& e) {
    context.error(key, e.what());
  }
}

}  // namespace sphgeo
