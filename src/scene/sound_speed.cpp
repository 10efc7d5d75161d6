#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "boundaries/exchange.h"
#include "materials/solid.h"
#include "materials/water.h"
#include "scene/build.h"

namespace sphgeo {
namespace {

struct Candidate {
  double speed = 0;
  std::string because = "no body or boundary of the deck moves or can fall";
  void offer(double v, std::string why) {
    if (v > speed) {
      speed = v;
      because = std::move(why);
    }
  }
};

// The height of a box's highest and lowest corner, against gravity.
double highest(const Aabb& box, const Vec3& up) {
  double h = 0;
  for (int k = 0; k < 3; ++k)
    if (up[k] != 0) h += std::max(box.lo[k] * up[k], box.hi[k] * up[k]);
  return h;
}
double lowest(const Aabb& box, const Vec3& up) { return -highest(box, -up); }

}  // namespace

SoundSpeed water_sound_speed(const Model& model, const Aabb& water, const Aabb& everything) {
  const auto* material = dynamic_cast<const Water*>(model.liquid());
  if (!material) return {0, 0, "there is no water"};
  if (material->sound_speed)
    return {*material->sound_speed, *material->sound_speed / 10,
            "sound_speed of the material is given"};
  if (material->max_speed)
    return {10 * *material->max_speed, *material->max_speed, "ten times max_speed of the material"};

  Candidate best;
  const double g = model.gravity.norm();
  const Vec3 up = g > 0 ? Vec3(-model.gravity / g) : Vec3(Vec3::UnitZ());
  if (g > 0 && !water.empty()) {
    const double fall = highest(water, up) - lowest(everything, up);
    if (fall > 0)
      best.offer(2 * std::sqrt(g * fall),
                 fmt::format("2 sqrt(g H), the front speed of a dam break, for the height H = "
                             "{:.4g} m of the water above the lowest point of the scene",
                             fall));
  }
  for (const Body& b : model.bodies) {
    if (!b.shape) continue;
    const Aabb box = b.shape->box();
    if (const double fall = highest(box, up) - lowest(everything, up);
        g > 0 && fall > 0 && std::isfinite(fall) && solid_of(model, b))
      best.offer(std::sqrt(2 * g * fall),
                 fmt::format("the speed sqrt(2 g H) of the fall of body '{}', for its height H "
                             "= {:.4g} m above the lowest point of the scene",
                             b.name, fall));
    for (int corner = 0; corner < 9; ++corner) {
      Vec3 at = 0.5 * (box.lo + box.hi);
      if (corner < 8)
        for (int k = 0; k < 3; ++k) at[k] = (corner >> k) & 1 ? box.hi[k] : box.lo[k];
      if (!at.allFinite()) continue;
      const Vec3 v(b.velocity[0](at, 0), b.velocity[1](at, 0), b.velocity[2](at, 0));
      if (v.allFinite())
        best.offer(v.norm(),
                   fmt::format("the initial speed {:.4g} m/s of body '{}'", v.norm(), b.name));
      const double p = b.pressure.word.empty() ? std::abs(b.pressure.formula(at, 0)) : 0.0;
      if (p > 0 && std::isfinite(p))
        best.offer(
            std::sqrt(2 * p / material->density),
            fmt::format(
                "the speed sqrt(2 p / rho0) that the initial pressure of body '{}' can drive",
                b.name));
    }
  }
  for (const auto& b : model.boundaries) {
    if (const auto* inlet = dynamic_cast<const Inlet*>(b.get())) {
      const double end = std::min(inlet->until.value_or(model.end_time), model.end_time);
      double v = 0;
      for (int k = 0; k <= 100; ++k)
        v = std::max(v, inlet->velocity_at(inlet->from + (end - inlet->from) * k / 100).norm());
      best.offer(v, fmt::format("the speed {:.4g} m/s of inlet '{}'", v, b->name));
      const double fall = highest(inlet->source_box(), up) - lowest(everything, up);
      if (g > 0 && fall > 0 && std::isfinite(fall))
        best.offer(std::sqrt(v * v + 2 * g * fall),
                   fmt::format("the speed of the fall from inlet '{}', for its height H = {:.4g} m "
                               "above the lowest point of the scene",
                               b->name, fall));
    }
    const auto* wall = dynamic_cast<const WallBoundary*>(b.get());
    if (!wall || !wall->motion) continue;
    const double v = wall->motion->max_speed(0.5 * (water.lo + water.hi), model.end_time);
    best.offer(v, fmt::format("the speed {:.4g} m/s of boundary '{}'", v, b->name));
  }
  return {10 * best.speed, best.speed, "ten times " + best.because};
}

}  // namespace sphgeo
