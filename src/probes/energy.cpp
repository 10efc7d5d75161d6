#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/set_sums.h"

namespace sphgeo {
namespace {

/// Energies of the water.
struct EnergyProbe final : Probe {
  static Schema<EnergyProbe> schema() {
    return {"energy", "kinetic, potential and internal energy of the water"};
  }
  std::vector<Column> columns(const Model& model) const override {
    const char* unit = model.dimension == 2 ? "J/m" : "J";
    return {{"kinetic", unit, "kinetic energy"},
            {"potential", unit, "potential energy in the deck's gravity, zero at the origin"},
            {"internal", unit, "energy of compression, zero at rho0"},
            {"total", unit, "their sum"}};
  }
  std::vector<FieldRequest> needs() const override { return {{"water", &fields::density}, {"water", &fields::mass}}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set("water")) return;
    const Energies e = water_energies(scene);
    out[0] = e.kinetic;
    out[1] = e.potential;
    out[2] = e.internal;
    out[3] = e.total();
  }
};

const Register<ProbeSpec, EnergyProbe> registered{"energy"};

}  // namespace
}  // namespace sphgeo
