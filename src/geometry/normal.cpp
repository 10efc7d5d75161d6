#include "geometry/normal.h"

#include <cmath>

namespace sphgeo {

Vec3 outward_normal(const Shape& shape, const Vec3& p, double step, int dim) {
  // On a ridge of the distance function the two sides of a difference cancel exactly; a wider
  // stencil then shows which side is nearer. 0.3 tells a ridge from a 90 degree edge (0.7). On the
  // mid-plane of a plate it shows neither, and would extend to the far ends: there a stencil beside
  // the point selects one of the sides.
  Vec3 best = Vec3::Zero();
  const auto look = [&](const Vec3& at, double h) {
    Vec3 g = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      if (dim == 2 && k == 1) continue;
      Vec3 a = at, b = at;
      a[k] -= h;
      b[k] += h;
      g[k] = (shape.signed_distance(b) - shape.signed_distance(a)) / (2.0 * h);
    }
    if (g.allFinite() && g.norm() > best.norm()) best = g;
    return best.norm() > 0.3;
  };
  double h = step;
  for (int attempt = 0; attempt < 4; ++attempt, h *= 3.0)
    if (look(p, h) || look(p + h * Vec3(0.61, dim == 2 ? 0.0 : 0.47, 0.54), h)) break;
  return best.norm() > 1e-9 ? Vec3(best.normalized()) : Vec3(Vec3::UnitZ());
}

Vec3 project_to_level(const Shape& shape, const Vec3& p, double level, double step, int dim) {
  Vec3 q = p;
  double off = shape.signed_distance(q) - level;
  for (int k = 0; k < 20 && std::abs(off) > 1e-9 * step; ++k) {
    const Vec3 n = outward_normal(shape, q, step, dim);
    // Half steps when a full one overshoots into a kink.
    double share = 1.0;
    for (int halving = 0; halving < 5; ++halving, share *= 0.5) {
      const Vec3 next = q - share * off * n;
      const double next_off = shape.signed_distance(next) - level;
      if (std::abs(next_off) < std::abs(off)) {
        q = next;
        off = next_off;
        break;
      }
      if (halving == 4) return q;
    }
  }
  return q;
}

}  // namespace sphgeo
