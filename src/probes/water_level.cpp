#include <algorithm>
#include <cmath>

#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Height of the free surface above a place: where the kernel sum of the water falls to one half.
struct WaterLevelProbe final : Probe {
  Vec3 at = Vec3::Zero();

  static Schema<WaterLevelProbe> schema() {
    Schema<WaterLevelProbe> s("water_level", "height of the topmost water surface at a place");
    s.required("at", &WaterLevelProbe::at, unit::length, "the place; its z is ignored");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"level", "m", "z of the free surface; empty where there is no water"}};
  }
  std::vector<FieldRequest> needs() const override { return {{"water", &fields::volume}}; }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set("water") || scene.size("water") == 0) return;
    const double dp = scene.spacing("water");
    const auto x = scene.vector("water", fields::position);
    const auto volume = scene.scalar("water", fields::volume);
    const auto filled = [&](double z) {
      double sum = 0;
      scene.near("water", {at.x(), at.y(), z}, [&](Index i, double w) { sum += volume(i) * w; });
      return sum;
    };
    // From the highest particle of the neighborhood down to the first half-filled kernel.
    double top = -INFINITY, bottom = INFINITY;
    const double reach = 2 * scene.smoothing_length("water");
    for (Index i = 0; i < scene.size("water"); ++i) {
      const Vec3 p = x(i);
      if (std::abs(p.x() - at.x()) > reach || std::abs(p.y() - at.y()) > reach) continue;
      top = std::max(top, p.z());
      bottom = std::min(bottom, p.z());
    }
    double above = 0;
    for (double z = top + 2 * dp; z > bottom - dp; z -= 0.25 * dp) {
      const double here = filled(z);
      if (here >= 0.5) {
        out[0] = z + 0.25 * dp * (here - 0.5) / std::max(here - above, 1e-12);
        return;
      }
      above = here;
    }
  }
};

const Register<ProbeSpec, WaterLevelProbe> registered{"water_level"};

}  // namespace
}  // namespace sphgeo
