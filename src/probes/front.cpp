#include <cmath>

#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Front position of a set in a direction.
struct FrontProbe final : Probe {
  std::string set = "water";
  Vec3 direction = Vec3::UnitX();
  std::optional<Vec3> region_min, region_max;

  static Schema<FrontProbe> schema() {
    Schema<FrontProbe> s("front", "front position of a set in a direction");
    s.optional("set", &FrontProbe::set, unit::none, "the particle set");
    s.optional("direction", &FrontProbe::direction, unit::none, "the direction, of any length")
        .keep_y();
    s.optional("region_min", &FrontProbe::region_min, unit::length,
               "lower corner of the region considered");
    s.optional("region_max", &FrontProbe::region_max, unit::length,
               "upper corner of the region considered");
    s.check([](FrontProbe& p, CheckContext& c) {
      if (!(p.direction.norm() > 0))
        c.error("direction", "the direction has no length", "give a vector that is not zero");
      else p.direction.normalize();
    });
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"position", "m",
             "position of the foremost particle along the direction, plus half a spacing"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{set, &fields::position}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    const auto x = scene.vector(set, fields::position);
    const bool flat = scene.dimension() == 2;
    const auto counts = [&](const Vec3& p) {
      for (int k = 0; k < 3; ++k) {
        if (k == 1 && flat) continue;
        if (region_min && p[k] < (*region_min)[k]) return false;
        if (region_max && p[k] > (*region_max)[k]) return false;
      }
      return true;
    };
    const double most = block_max(scene.size(set), [&](Index i) {
      const Vec3 p = x(i);
      return counts(p) ? p.dot(direction) : -INFINITY;
    });
    if (std::isfinite(most)) out[0] = most + 0.5 * scene.spacing(set);
  }
};

const Register<ProbeSpec, FrontProbe> registered_front{"front"};

}  // namespace
}  // namespace sphgeo
