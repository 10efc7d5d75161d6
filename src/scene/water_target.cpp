#include "scene/water_target.h"

#include <algorithm>
#include <cmath>

#include "geometry/shapes.h"
#include "materials/soil.h"

namespace sphgeo {

double distance_near(const Shape& shape, const Vec3& at, double reach) {
  const double d = shape.bound(at);
  return std::abs(d) < reach && shape.composed() ? shape.signed_distance(at) : d;
}

WaterTarget::WaterTarget(const Model& model) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto* soil = dynamic_cast<const Soil*>(model.material(body.material));
    if (!soil || !body.shape) continue;
    Skeleton s{b, body.shape, body.shape->box(), Expression(soil->volume_fraction.value_or(NAN)),
               false};
    if (body.volume_fraction) s.amount = *body.volume_fraction;
    if (body.porosity) {
      s.amount = *body.porosity;
      s.porosity = true;
    }
    soils_.push_back(std::move(s));
  }
}

WaterTarget::Where WaterTarget::locate(const Vec3& at) const {
  Where out{-1, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < soils_.size(); ++k) {
    const double d = soils_[k].shape->bound(at);
    if (d < 0) return {static_cast<int>(k), std::min(out.holds, -d)};
    out.holds = std::min(out.holds, d);
  }
  return out;
}

double WaterTarget::fraction(const Vec3& at) const {
  return std::min(fraction_in(locate(at).soil, at), 1.0);
}

double WaterTarget::mean_fraction(const Vec3& at, double edge) const {
  double solid = 0, left = 1;  // what no earlier soil has taken
  for (const Skeleton& s : soils_) {
    const double share =
        std::min(left, std::clamp(0.5 - distance_near(*s.shape, at, edge) / edge, 0.0, 1.0));
    if (share == 0) continue;
    solid += share * s.solid(at);
    left -= share;
  }
  return 1 - solid;
}

}  // namespace sphgeo
