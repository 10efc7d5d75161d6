#include "geometry/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace sphgeo {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// The search from one point; g is negative on the point's side of the surface.
class FootSearch {
 public:
  FootSearch(const std::function<double(const Vec3&)>& bound, const Vec3& p, double at_p, bool flat)
      : bound_(bound), p_(p), sign_(at_p > 0.0 ? -1.0 : 1.0), reach_(std::abs(at_p)), flat_(flat) {}

  double run() const {
    const Vec3 n = gradient(p_, 1e-4 * reach_ + 1e-12);
    if (foot_is_on_surface(n)) return reach_;
    struct Hit {
      Vec3 direction;
      double distance;
    };
    std::vector<Hit> hits;
    double best = inf;
    auto shoot = [&](const Vec3& direction) {
      // Hits much farther than the best cannot descend to a nearer point than the best does.
      const double t = march(direction, 2.0 * best, reach_);
      if (t == inf) return false;
      hits.push_back({direction, t});
      best = std::min(best, t);
      return true;
    };
    if (n.norm() > 0.1) shoot(n.normalized());
    std::vector<Vec3> missed;
    for (const Vec3& d : directions(flat_))
      if (!shoot(d)) missed.push_back(d);
    // A ray along a seam advances slowly; once a length is known it may take longer steps.
    if (best < inf)
      for (const Vec3& d : missed) shoot(d);
    double result = best;
    for (const Hit& hit : hits)
      if (hit.distance <= 1.5 * best) result = std::min(result, slide(hit.direction, hit.distance));
    return result == inf ? reach_ : std::max(result, reach_);
  }

 private:
  double g(const Vec3& q) const { return sign_ * bound_(q); }

  Vec3 gradient(const Vec3& q, double h) const {
    Vec3 d = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      if (flat_ && k == 1) continue;
      Vec3 a = q, b = q;
      a[k] -= h;
      b[k] += h;
      d[k] = (g(b) - g(a)) / (2.0 * h);
    }
    return d;
  }

  /// The bound is a lower limit of the distance, so a true surface point at that distance proves
  /// it.
  bool foot_is_on_surface(const Vec3& n) const {
    if (std::abs(n.norm() - 1.0) > 1e-3) return false;
    const double beyond = 1e-3 * reach_;
    return std::abs(g(p_ + reach_ * n)) < 1e-4 * reach_ &&
           g(p_ + (reach_ + beyond) * n) > 0.5 * beyond;
  }

  /// Distance along a ray to the surface; inf when it is farther than `limit` or never met. Steps
  /// as long as the bound allows, yet not so short that touching parts stop the ray at their seam.
  double march(const Vec3& direction, double limit, double start) const {
    double before = 0.0, t = start;
    const double least = limit < inf ? 0.01 * limit : 1e-12;
    for (int k = 0; k < 100; ++k) {
      if (t > limit) {
        if (before >= limit) break;
        t = limit;
      }
      const double v = g(p_ + t * direction);
      if (v > 0.0) {
        double after = t;
        for (int b = 0; b < 40 && after - before > 1e-7 * after; ++b) {
          const double mid = 0.5 * (before + after);
          (g(p_ + mid * direction) > 0.0 ? after : before) = mid;
        }
        return after;
      }
      before = t;
      t += std::max({-v, 0.01 * t, least});
    }
    return inf;
  }

  /// Turns the ray towards the foot of p on the tangent plane at the hit while that shortens it.
  double slide(Vec3 direction, double distance) const {
    for (int k = 0; k < 12; ++k) {
      const Vec3 q = p_ + distance * direction;
      Vec3 n = gradient(q + 2e-4 * distance * direction, 1e-4 * distance);
      if (n.norm() < 0.1) break;
      n.normalize();
      const Vec3 foot = p_ + (q - p_).dot(n) * n;
      bool better = false;
      for (double share = 1.0; share > 1e-3; share *= 0.5) {
        const Vec3 to = q + share * (foot - q) - p_;
        const double length = to.norm();
        if (length < 1e-300) continue;
        // Starting just before the foot avoids the small steps of a ray along a seam.
        const double start = 0.9 * length;
        const bool clear = g(p_ + start * (to / length)) <= 0.0;
        const double t = march(to / length, distance, clear ? start : reach_);
        if (t < distance * (1.0 - 1e-6)) {
          direction = to / length;
          distance = t;
          better = true;
          break;
        }
      }
      if (!better) break;
    }
    return distance;
  }

  static const std::vector<Vec3>& directions(bool flat) {
    static const std::array<std::vector<Vec3>, 2> sets = [] {
      std::array<std::vector<Vec3>, 2> out;
      for (int x = -2; x <= 2; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -2; z <= 2; ++z) {
            const Vec3 d(x, y, z);
            const bool ring =
                std::max(std::abs(x), std::abs(z)) == 2 && std::abs(x) + std::abs(z) != 0;
            if (y == 0 && ring) out[1].push_back(d.normalized());  // 16 directions in the plane
            if (std::max(std::abs(x), std::abs(z)) <= 1 && d.norm() > 0.0)
              out[0].push_back(d.normalized());  // 26 in space
          }
      return out;
    }();
    return sets[flat ? 1 : 0];
  }

  const std::function<double(const Vec3&)>& bound_;
  Vec3 p_;
  double sign_;
  double reach_;
  bool flat_;
};

}  // namespace

double refined_distance(const std::function<double(const Vec3&)>& bound, const Vec3& p,
                        int exact_sign, bool flat) {
  const double v = bound(p);
  if (v * exact_sign >= 0.0 || !std::isfinite(v)) return v;
  const double d = FootSearch(bound, p, v, flat).run();
  return v > 0.0 ? d : -d;
}

}  // namespace sphgeo
