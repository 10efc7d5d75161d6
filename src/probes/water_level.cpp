#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/surface.h"

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
    out[0] = surface_heights(scene, "water", {at})[0];
  }
};

const Register<ProbeSpec, WaterLevelProbe> registered{"water_level"};

}  // namespace
}  // namespace sphgeo
