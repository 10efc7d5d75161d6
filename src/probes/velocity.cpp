#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Velocity at a fixed point.
struct VelocityProbe final : Probe {
  std::string set = "water";
  Vec3 at = Vec3::Zero();

  static Schema<VelocityProbe> schema() {
    Schema<VelocityProbe> s("velocity",
                            "velocity at a fixed point, by a linear fit to the set around it");
    s.optional("set", &VelocityProbe::set, unit::none, "the particle set");
    s.required("at", &VelocityProbe::at, unit::length, "the point");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    return vector_columns(model, "v", unit::speed, "velocity; empty without particles");
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{set, &fields::velocity}, {set, &fields::volume}};
  }
  std::vector<Vec3> positions() const override { return {at}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const PointFit fit(scene, set, at);
    if (fit.supported()) store_vector(scene, fit(scene.vector(set, fields::velocity)), out);
  }
};

const Register<ProbeSpec, VelocityProbe> registered_velocity{"velocity"};

}  // namespace
}  // namespace sphgeo
