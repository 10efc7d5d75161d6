#include "geometry/distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sphgeo {

double box_distance(const Vec3& p, const Vec3& lo, const Vec3& hi, bool flat) {
  Vec3 d = (lo - p).cwiseMax(p - hi);
  if (flat) d.y() = std::max(d.x(), d.z());
  const double inside = std::min(d.maxCoeff(), 0.0);
  if (flat) d.y() = 0.0;
  return d.cwiseMax(0.0).norm() + inside;
}

namespace {

/// The closest point of an ellipsoid solves g(u) = sum (r_i z_i / (u + r_i - 1))^2 - 1 = 0, where
/// z = p / e and r = (e / e_min)^2. g falls on u > 0 from +inf, so a safeguarded Newton iteration
/// cannot fail. Working with u instead of u - 1 keeps its relative accuracy near the medial plane,
/// where u -> 0.
template <int N>
double ellipsoid_root_distance(const Eigen::Matrix<double, N, 1>& p,
                               const Eigen::Matrix<double, N, 1>& e) {
  int last = 0;
  const double e_min = e.minCoeff(&last);
  Eigen::Matrix<double, N, 1> z = p.cwiseAbs().cwiseQuotient(e);
  const Eigen::Matrix<double, N, 1> r = (e / e_min).cwiseAbs2();
  z[last] = std::max(z[last], 1e-13);  // moves p by 1e-13 e_min: avoids the case split at the plane
  const double level = z.squaredNorm() - 1.0;
  double lo = 0.0;  // no single term exceeds 1
  for (int i = 0; i < N; ++i) lo = std::max(lo, r[i] * z[i] - (r[i] - 1.0));
  double hi = std::max(1.0, level > 0.0 ? r.cwiseProduct(z).norm() : 1.0);
  double u = level > 0.0 ? hi : lo;
  for (int k = 0; k < 200; ++k) {
    double g = -1.0, slope = 0.0;
    for (int i = 0; i < N; ++i) {
      const double w = 1.0 / (u + (r[i] - 1.0)), q = r[i] * z[i] * w;
      g += q * q;
      slope -= 2.0 * q * q * w;
    }
    (g > 0.0 ? lo : hi) = u;
    // Newton where it stays within the bracket, else halving.
    double next = u - g / slope;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    const bool settled = std::abs(next - u) <= 1e-15 * u;
    u = next;
    if (settled || hi - lo <= 1e-15 * hi) break;
  }
  double sum = 0.0;
  for (int i = 0; i < N; ++i) {
    const double q = e[i] * z[i] / (u + (r[i] - 1.0));
    sum += q * q;
  }
  return (u - 1.0) * std::sqrt(sum);
}

double segment_distance_squared(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * d).squaredNorm();
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double polygon_distance(const Vec2& p, const Vec2* corners, std::size_t n) {
  double best = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t i = 0, j = n - 1; i < n; j = i++) {
    const Vec2& a = corners[j];
    const Vec2& b = corners[i];
    best = std::min(best, segment_distance_squared(p, a, b));
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside ? -std::sqrt(best) : std::sqrt(best);
}

}  // namespace

double ellipse_distance(const Vec2& p, const Vec2& semi_axes) {
  return ellipsoid_root_distance<2>(p, semi_axes);
}

double ellipsoid_distance(const Vec3& p, const Vec3& semi_axes) {
  return ellipsoid_root_distance<3>(p, semi_axes);
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * d).norm();
}

double polygon_distance(const Vec2& p, const std::vector<Vec2>& corners) {
  return polygon_distance(p, corners.data(), corners.size());
}

double frustum_distance(const Vec3& p, const Vec3& from, const Vec3& to, double r_from,
                        double r_to) {
  const Vec3 axis = to - from;
  const double length = axis.norm();
  const double t = (p - from).dot(axis) / length;
  const double r = (p - from - axis * (t / length)).norm();
  // The section through the axis and p; its mirror half keeps the axis from being a boundary.
  const std::array<Vec2, 4> section{Vec2{-r_from, 0.0}, Vec2{r_from, 0.0}, Vec2{r_to, length},
                                    Vec2{-r_to, length}};
  return polygon_distance(Vec2{r, t}, section.data(), section.size());
}

double extruded_distance(double section, double along) {
  const double inside = std::min(std::max(section, along), 0.0);
  return inside + std::hypot(std::max(section, 0.0), std::max(along, 0.0));
}

bool polygon_crosses_itself(const std::vector<Vec2>& c) {
  const std::size_t n = c.size();
  auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) { return cross(b - a, p - a); };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& a = c[i];
    const Vec2& b = c[(i + 1) % n];
    for (std::size_t j = i + 1; j < n; ++j) {
      if ((j + 1) % n == i || j == i + 1) continue;  // neighbours share a corner
      const Vec2& d = c[j];
      const Vec2& e = c[(j + 1) % n];
      const double s1 = side(a, b, d), s2 = side(a, b, e), s3 = side(d, e, a), s4 = side(d, e, b);
      if (s1 * s2 < 0.0 && s3 * s4 < 0.0) return true;
      if (segment_distance_squared(d, a, b) == 0.0 || segment_distance_squared(e, a, b) == 0.0)
        return true;
    }
  }
  return false;
}

double polygon_area(const std::vector<Vec2>& c) {
  double twice = 0.0;
  for (std::size_t i = 0, j = c.size() - 1; i < c.size(); j = i++) twice += cross(c[j], c[i]);
  return 0.5 * twice;
}

}  // namespace sphgeo
