#pragma once
// Signed distances of the elementary shapes in closed form or by a safe iteration: negative inside,
// positive outside, metres. Shapes, boundaries and tests share them.

#include <vector>

#include "core/types.h"

namespace sphgeo {

using Vec2 = Eigen::Vector2d;

/// Exact distance to the axis-aligned box between `lo` and `hi`; `flat` leaves y out.
double box_distance(const Vec3& p, const Vec3& lo, const Vec3& hi, bool flat);

/// Exact distance to the ellipse x^2/a^2 + z^2/b^2 = 1 around the origin; a, b > 0.
double ellipse_distance(const Vec2& p, const Vec2& semi_axes);

/// Exact distance to the ellipsoid around the origin; all semi-axes > 0.
double ellipsoid_distance(const Vec3& p, const Vec3& semi_axes);

/// Distance to the segment a-b (never negative); a = b is allowed.
double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);

/// Exact distance to a simple polygon given by its corners in either sense.
double polygon_distance(const Vec2& p, const std::vector<Vec2>& corners);

/// Exact distance to a frustum between `from` (radius `r_from`) and `to` (radius `r_to`), flat
/// ends. In the plane y = 0 it is its own lengthwise section.
double frustum_distance(const Vec3& p, const Vec3& from, const Vec3& to, double r_from,
                        double r_to);

/// Distance to the prism whose section has the distance `section` and whose ends are at `along`
/// (signed distance to the slab between the ends). Exact when `section` is.
double extruded_distance(double section, double along);

/// Whether two edges of the closed polygon cross or touch other than at a shared corner.
bool polygon_crosses_itself(const std::vector<Vec2>& corners);

/// Area of a closed polygon, positive when the corners run from x towards z (counter-clockwise).
double polygon_area(const std::vector<Vec2>& corners);

}  // namespace sphgeo
