#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/hash.h"
#include "geometry/distance.h"
#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {
namespace {

/// A tree on stilt roots: chains of capsules that leave the trunk, arch over and reach the ground,
/// some with a branch (after the Rhizophora of flume experiments: arches that are parabolas of the
/// distance from the trunk).
struct Mangrove final : SceneShape {
  Vec3 foot = Vec3::Zero();
  double trunk_radius = 0, height = 0;
  int roots = 12;
  double root_radius = 0, spread = 0, root_height = 0;
  double branching = 0.5;
  double below = 0;
  int segments = 8;
  Index seed = 1;

  static Schema<Mangrove> schema() {
    Schema<Mangrove> s("mangrove",
                       "A tree on stilt roots: a trunk, and arched roots made of capsules. In 2D "
                       "its section with the plane y = 0.");
    s.required("foot", &Mangrove::foot, unit::length, "The point of the ground below the trunk.");
    s.required("height", &Mangrove::height, unit::length,
               "Height of the top of the trunk above the foot.")
        .above(0);
    s.required("trunk_radius", &Mangrove::trunk_radius, unit::length,
               "Radius of the trunk, which begins at the highest root.")
        .above(0);
    s.required("root_radius", &Mangrove::root_radius, unit::length,
               "Radius of a root at the trunk; it tapers to 0.6 of that at the ground.")
        .above(0);
    s.required("root_height", &Mangrove::root_height, unit::length,
               "Largest height at which a root leaves the trunk; the least is 0.4 of it.")
        .above(0);
    s.required("spread", &Mangrove::spread, unit::length,
               "Largest distance from the trunk at which a root reaches the ground; the least is "
               "half of it.")
        .above(0);
    s.optional("roots", &Mangrove::roots, unit::none, "Number of roots.").at_least(1).at_most(500);
    s.optional("branching", &Mangrove::branching, unit::none,
               "Fraction of the roots that have a branch.")
        .at_least(0)
        .at_most(1);
    s.optional("below", &Mangrove::below, unit::length, "Length of the roots below the foot.")
        .at_least(0);
    s.optional("segments", &Mangrove::segments, unit::none, "Number of capsules in a root.")
        .at_least(2)
        .at_most(100);
    s.optional("seed", &Mangrove::seed, unit::none, "Another seed gives another tree.").at_least(0);
    s.check([](Mangrove& m, CheckContext& c) {
      set_scene(m, c);
      if (m.root_height > m.height)
        c.error("root_height", "roots leave the trunk above its top",
                "a height below that of the trunk");
      m.grow();
    });
    return s;
  }

  double signed_distance(const Vec3& at) const override {
    double least = segment_distance(at, trunk_[0], trunk_[1]) - trunk_radius;
    for (const Piece& p : pieces_) {
      // A piece whose bounding ball is farther away than the best distance cannot be the nearest.
      if ((at - p.middle).norm() - p.reach >= least) continue;
      least = std::min(least, segment_distance(at, p.a, p.b) - p.radius);
    }
    return least;
  }

  Aabb box() const override {
    Aabb box = box_of_balls(trunk_[0], trunk_radius, trunk_[1], trunk_radius);
    for (const Piece& p : pieces_) box.extend(box_of_balls(p.a, p.radius, p.b, p.radius));
    return seen(box);
  }

 private:
  struct Piece {
    Vec3 a, b, middle;
    double radius, reach;
  };

  void add(const Vec3& a, const Vec3& b, double radius) {
    pieces_.push_back({a, b, 0.5 * (a + b), radius, 0.5 * (b - a).norm() + radius});
  }

  /// A parabola from `start` that leaves with a fifth of its mean slope, bends down and ends at
  /// `end`.
  void arch(const Vec3& start, const Vec3& end, double radius, double tip) {
    Vec3 last = start;
    for (int k = 1; k <= segments; ++k) {
      const double s = static_cast<double>(k) / segments;
      Vec3 at = start + s * (end - start);
      at.z() += 0.8 * s * (1 - s) * (start.z() - end.z());
      add(last, at, radius + (tip - radius) * (s - 0.5 / segments));
      last = at;
    }
    if (below > 0) add(last, last - Vec3(0, 0, below), tip);
  }

  void grow() {
    pieces_.clear();
    std::uint64_t draw = 0;
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * random_uniform(static_cast<std::uint64_t>(seed), draw++);
    };
    trunk_[0] = foot + Vec3(0, 0, 0.4 * root_height);
    trunk_[1] = foot + Vec3(0, 0, height);
    for (int k = 0; k < roots; ++k) {
      const double turn = 2 * std::numbers::pi * (k + uniform(-0.3, 0.3)) / roots;
      const Vec3 out(std::cos(turn), std::sin(turn), 0);
      const double from = uniform(0.4, 1.0) * root_height, far = uniform(0.5, 1.0) * spread;
      const Vec3 start = foot + Vec3(0, 0, from), end = foot + far * out;
      arch(start, end, root_radius, 0.6 * root_radius);
      const double chance = uniform(0, 1), at = uniform(0.3, 0.5), aside = uniform(-1, 1);
      if (chance >= branching) continue;
      Vec3 fork = start + at * (end - start);
      fork.z() += 0.8 * at * (1 - at) * from;
      const Vec3 across(-out.y(), out.x(), 0);
      arch(fork, foot + 0.8 * far * out + 0.35 * far * aside * across, 0.7 * root_radius,
           0.5 * root_radius);
    }
  }

  Vec3 trunk_[2] = {Vec3::Zero(), Vec3::Zero()};
  std::vector<Piece> pieces_;
};

const Register<Shape, Mangrove> registered_mangrove{"mangrove"};

}  // namespace
}  // namespace sphgeo
