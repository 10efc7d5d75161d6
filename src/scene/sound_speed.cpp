#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

SoundSpeed water_sound_speed(const Model& model, const Aabb& water, const Aabb& everything) {
  const Water* material = nullptr;
  for (const auto& m : model.materials)
    if (const auto* w = dynamic_cast<const Water*>(m.get())) material = w;
  if (!material) return {0, 0, "there is no water"};
  if (material->sound_speed)
    return {*material->sound_speed, *material->sound_speed / 10,
            "sound_speed of the material is given"};
  if (material->max_speed)
    return {10 * *material->max_speed, *material->max_speed, "ten times max_speed of the material"};

  Candidate best;
  const double g = model.gravity.norm();
  if (g > 0 && !water.empty()) {
    const double fall = water.hi.z() - everything.lo.z();
    if (fall > 0)
      best.offer(2 * std::sqrt(g * fall),
                 fmt::format("2 sqrt(g H), the front speed of a dam break, for the height H = "
                             "{:.4g} m of the water above the lowest point of the scene",
                             fall));
  }
  for (const Body& b : model.bodies) {
    if (!b.shape) continue;
    const Aabb box = b.shape->box();
    if (const double fall = box.hi.z() - everything.lo.z();
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
    const auto* wall = dynamic_cast<const WallBoundary*>(b.get());
    if (!wall || !wall->motion) continue;
    const double v = wall->motion->max_speed(0.5 * (water.lo + water.hi), model.end_time);
    best.offer(v, fmt::format("the speed {:.4g} m/s of boundary '{}'", v, b->name));
  }
  return {10 * best.speed, best.speed, "ten times " + best.because};
}

}  // namespace sphgeo
