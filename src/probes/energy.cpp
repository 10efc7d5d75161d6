#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/set_sums.h"

namespace sphgeo {
namespace {

/// Energies of the water or of the soil.
struct EnergyProbe final : Probe {
  std::string set = "water";

  static Schema<EnergyProbe> schema() {
    Schema<EnergyProbe> s("energy", "kinetic, potential and internal energy of water or soil");
    s.optional("set", &EnergyProbe::set, unit::none, "the particle set").choices({"water", "soil"});
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    const char* unit = model.dimension == 2 ? "J/m" : "J";
    std::vector<Column> columns{{"kinetic", unit, "kinetic energy"},
                                {"potential", unit, "potential energy in the deck's gravity, zero at the origin"},
                                {"internal", unit, set == "soil" ? "elastic energy" : "energy of compression, zero at rho0"},
                                {"total", unit, "their sum"}};
    if (set == "soil") columns.push_back({"dissipated", unit, "energy dissipated by plastic flow so far"});
    return columns;
  }
  std::vector<FieldRequest> needs() const override {
    if (set == "soil") return {{"soil", &fields::stress}, {"soil", &fields::volume}, {"soil", &fields::plastic_work}};
    return {{"water", &fields::density}, {"water", &fields::mass}};
  }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    const Energies e = set == "soil" ? soil_energies(scene) : water_energies(scene);
    if (set == "soil") out[4] = dissipated_energy(scene);
    out[0] = e.kinetic;
    out[1] = e.potential;
    out[2] = e.internal;
    out[3] = e.total();
  }
};

const Register<ProbeSpec, EnergyProbe> registered{"energy"};

}  // namespace
}  // namespace sphgeo
