#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Water pressure at a fixed point.
struct PressureProbe final : Probe {
  Vec3 at = Vec3::Zero();

  static Schema<PressureProbe> schema() {
    Schema<PressureProbe> s(
        "pressure", "water pressure at a fixed point, by a linear fit to the water around it");
    s.required("at", &PressureProbe::at, unit::length, "the point; it may lie on a wall");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"pressure", "Pa", "water pressure; empty where there is no water"},
            {"support", "1", "share of the kernel filled with water"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{"water", &fields::pressure}, {"water", &fields::volume}};
  }
  std::vector<Vec3> positions() const override { return {at}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const PointFit fit(scene, "water", at);
    out[1] = fit.support();
    if (fit.supported()) out[0] = fit(scene.scalar("water", fields::pressure));
  }
};

const Register<ProbeSpec, PressureProbe> registered_pressure{"pressure"};

}  // namespace
}  // namespace sphgeo
