#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Water velocity at a fixed point.
struct VelocityProbe final : Probe {
  Vec3 at = Vec3::Zero();

  static Schema<VelocityProbe> schema() {
    Schema<VelocityProbe> s("velocity", "water velocity at a fixed point, by a linear fit to the water around it");
    s.required("at", &VelocityProbe::at, unit::length, "the point");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    return vector_columns(model, "v", unit::speed, "velocity of the water; empty where there is none");
  }
  std::vector<FieldRequest> needs() const override { return {{"water", &fields::velocity}, {"water", &fields::volume}}; }
  std::vector<Vec3> places() const override { return {at}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const PointFit fit(scene, "water", at);
    if (fit.supported()) store_vector(scene, fit(scene.vector("water", fields::velocity)), out);
  }
};

const Register<ProbeSpec, VelocityProbe> registered{"velocity"};

}  // namespace
}  // namespace sphgeo
