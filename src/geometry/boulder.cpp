#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/hash.h"
#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {
namespace {

/// A boulder: a ball (in 2D a disc) with smooth seeded bumps. The surface is r = radius (1 +
/// bumps(direction)).
struct Boulder final : SceneShape {
  Vec3 center = Vec3::Zero();
  double radius = 0;
  double roughness = 0.15;
  Index seed = 1;

  static constexpr int waves = 12;

  static Schema<Boulder> schema() {
    Schema<Boulder> s("boulder",
                      "A boulder: a ball, in 2D a disc, whose radius varies smoothly and randomly "
                      "with direction.");
    s.required("center", &Boulder::center, unit::length, "The center.");
    s.required("radius", &Boulder::radius, unit::length, "The mean radius.").above(0);
    s.optional("roughness", &Boulder::roughness, unit::none,
               "Largest deviation of the radius, as a fraction of it.")
        .at_least(0)
        .at_most(0.4);
    s.optional("seed", &Boulder::seed, unit::none, "Another seed gives another shape.").at_least(0);
    s.check([](Boulder& b, CheckContext& c) {
      set_scene(b, c);
      b.prepare();
    });
    return s;
  }

  /// Plane waves of 1.5 to 3 periods around the ball, cut at y = 0 in 2D; their amplitudes add up
  /// to `roughness` at most.
  void prepare() {
    std::uint64_t draw = 0;
    const auto uniform = [&] { return random_uniform(static_cast<std::uint64_t>(seed), draw++); };
    double sum = 0;
    for (Wave& w : waves_) {
      const double z = 2 * uniform() - 1, angle = 2 * std::numbers::pi * uniform();
      const double across = std::sqrt(1 - z * z);
      const double number = 1.5 + 1.5 * uniform();
      w.k = number * (flat ? Vec3(std::cos(angle), 0, std::sin(angle))
                           : Vec3(across * std::cos(angle), across * std::sin(angle), z));
      w.phase = 2 * std::numbers::pi * uniform();
      w.amplitude = 1 / number;
      sum += w.amplitude;
    }
    // Waves with random phases do not add up to the sum of amplitudes: about its square root, times
    // the largest of a few directions.
    for (Wave& w : waves_) w.amplitude *= 2.5 * roughness / sum;
  }

  /// Radius less that of the surface, over the length of its gradient: exact to first order at the
  /// surface, where the slope of the bumps tilts it. The slope is that at the surface, also for
  /// points near the center.
  double signed_distance(const Vec3& at) const override {
    Vec3 d = at - center;
    if (flat) d.y() = 0;
    const double r = d.norm();
    if (r < 1e-9 * radius) return -radius * (1 - roughness);
    if (roughness <= 0) return r - radius;
    const Vec3 e = d / r;
    double sum = 0;
    Vec3 slope = Vec3::Zero();
    for (const Wave& w : waves_) {
      const double angle = w.k.dot(e) + w.phase;
      sum += w.amplitude * std::sin(angle);
      slope += w.amplitude * std::cos(angle) * w.k;
    }
    const double cut = std::tanh(sum / roughness), stretch = 1 + roughness * cut;
    slope *= (1 - cut * cut) / stretch;
    const double along = slope.dot(e);
    return (r - radius * stretch) / std::sqrt(1 + slope.squaredNorm() - along * along);
  }
  Aabb box() const override {
    const double reach = radius * (1 + roughness);
    return seen({center.array() - reach, center.array() + reach});
  }

 private:
  struct Wave {
    Vec3 k = Vec3::Zero();
    double phase = 0, amplitude = 0;
  };
  std::array<Wave, waves> waves_;
};

const Register<Shape, Boulder> registered_boulder{"boulder"};

}  // namespace
}  // namespace sphgeo
