#include <cmath>

#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {

/// The same solid with both ends required.
struct Prism final : Polygon {
  static Schema<Prism> schema();
};

const Register<Shape, Polygon> registered_polygon{"polygon"};
const Register<Shape, Prism> registered_prism{"prism"};

void check_polygon(Polygon& p, CheckContext& c) {
  set_scene(p, c);
  p.prepare();
  if (p.corners().size() < 3) return c.error("points", "a polygon needs at least three corners");
  if (polygon_crosses_itself(p.corners()))
    return c.error("points", "the polygon crosses or touches itself",
                   "list the corners in order around the outline, each once");
  if (polygon_area(p.corners()) == 0.0) c.error("points", "the polygon has no area");
  if (!p.flat && p.y_min && p.y_max && *p.y_max <= *p.y_min)
    c.error("y_max", "y_max must be larger than y_min");
}

}  // namespace

Schema<Polygon> Polygon::schema() {
  Schema<Polygon> s("polygon",
                    "A polygon in the x-z plane. In 3D it extends along y from y_min to y_max, and "
                    "is unbounded where they are not given.");
  s.required("points", &Polygon::points, unit::length,
             "The corners in order around the outline, in either sense; y is ignored.")
      .items(3, 5000);
  s.optional("y_min", &Polygon::y_min, unit::length, "One end in 3D; ignored in 2D.");
  s.optional("y_max", &Polygon::y_max, unit::length, "The other end in 3D; ignored in 2D.");
  s.check(check_polygon);
  return s;
}

Schema<Prism> Prism::schema() {
  Schema<Prism> s(
      "prism",
      "A polygon in the x-z plane extended along y from y_min to y_max; in 2D the polygon.");
  s.required("points", &Polygon::points, unit::length,
             "The corners in order around the outline, in either sense; y is ignored.")
      .items(3, 5000);
  s.required("y_min", &Polygon::y_min, unit::length, "One end; ignored in 2D.");
  s.required("y_max", &Polygon::y_max, unit::length, "The other end; ignored in 2D.");
  s.check([](Prism& p, CheckContext& c) { check_polygon(p, c); });
  return s;
}

void Polygon::prepare() {
  corners_.clear();
  for (const Vec3& p : points) corners_.emplace_back(p.x(), p.z());
  // A repeated first corner at the end, and corners given twice, also close the outline.
  std::erase_if(corners_, [&, k = std::size_t{0}](const Vec2& p) mutable {
    const std::size_t i = k++;
    return i > 0 && Vec2(points[i - 1].x(), points[i - 1].z()) == p;
  });
  if (corners_.size() > 1 && corners_.front() == corners_.back()) corners_.pop_back();
}

double Polygon::signed_distance(const Vec3& at) const {
  const double section = polygon_distance(Vec2{at.x(), at.z()}, corners_);
  if (flat || (!y_min && !y_max)) return section;
  constexpr double inf = std::numeric_limits<double>::infinity();
  return extruded_distance(
      section, std::max(y_min ? *y_min - at.y() : -inf, y_max ? at.y() - *y_max : -inf));
}

bool Polygon::along_axes() const {
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    const Vec2 side = corners_[(k + 1) % corners_.size()] - corners_[k];
    if (side.cwiseAbs().minCoeff() > 1e-12 * side.norm()) return false;
  }
  return true;
}

Aabb Polygon::box() const {
  Aabb b;
  for (const Vec2& p : corners_) b.extend(Vec3(p.x(), 0.0, p.y()));
  b.lo.y() = y_min.value_or(-std::numeric_limits<double>::infinity());
  b.hi.y() = y_max.value_or(std::numeric_limits<double>::infinity());
  return seen(b);
}

}  // namespace sphgeo
