#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/surface.h"

namespace sphgeo {
namespace {

/// Height of the free surface at a horizontal position: where the kernel sum of the water falls to
/// one half.
struct WaterLevelProbe final : Probe {
  Vec3 at = Vec3::Zero();
  std::optional<Vec3> minus;

  static Schema<WaterLevelProbe> schema() {
    Schema<WaterLevelProbe> s("water_level",
                              "height of the topmost water surface at a horizontal position");
    s.required("at", &WaterLevelProbe::at, unit::length, "the position; its z is ignored");
    s.optional("minus", &WaterLevelProbe::minus, unit::length,
               "a second position, whose level is subtracted in 'difference'; auto: no difference");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    std::vector<Column> out{{"level", "m", "z of the free surface; empty where there is no water"}};
    if (minus) out.push_back({"difference", "m", "level minus the level at the second position"});
    return out;
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{"water", &fields::volume}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const auto levels = surface_heights(
        scene, "water", minus ? std::vector<Vec3>{at, *minus} : std::vector<Vec3>{at});
    out[0] = levels[0];
    if (minus && levels[0] && levels[1]) out[1] = *levels[0] - *levels[1];
  }
};

const Register<ProbeSpec, WaterLevelProbe> registered_water_level{"water_level"};

}  // namespace
}  // namespace sphgeo
