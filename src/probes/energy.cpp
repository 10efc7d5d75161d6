#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/set_sums.h"
#include "probes/solid_scene.h"

namespace sphgeo {
namespace {

/// Energies of the water, of the soil, of all solids or of one.
struct EnergyProbe final : Probe {
  std::string set = "water";
  std::string body;

  static Schema<EnergyProbe> schema() {
    Schema<EnergyProbe> s("energy",
                          "kinetic, potential and internal energy of water, soil or solids");
    s.optional("set", &EnergyProbe::set, unit::none, "the particle set")
        .choices({"water", "soil", "solids"});
    s.optional("body", &EnergyProbe::body, unit::none, "for solids: the body; empty: all solids");
    s.check([](EnergyProbe& p, CheckContext& c) {
      if (!p.body.empty() && p.set != "solids")
        c.error("body", "'body' has no meaning for the " + p.set,
                "give set: solids, or leave 'body' out");
    });
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    const char* unit = model.dimension == 2 ? "J/m" : "J";
    std::vector<Column> columns{
        {"kinetic", unit, "kinetic energy"},
        {"potential", unit, "potential energy in the deck's gravity, zero at the origin"},
        {"internal", unit,
         set == "water" ? "energy of compression, zero at rho0" : "elastic energy"},
        {"total", unit, "their sum"}};
    if (set == "solids")
      columns.push_back(
          {"contact", unit, "energy stored in contacts, part of the internal energy"});
    if (set == "soil")
      columns.push_back({"dissipated", unit, "energy dissipated by plastic flow since t = 0"});
    return columns;
  }
  void inspect(const Model& model, CheckContext& c) const override {
    if (!body.empty()) inspect_body(model, body, "body", c);
  }
  std::vector<FieldRequest> needs(const Model& model) const override {
    if (set == "solids") {
      std::vector<FieldRequest> needs;
      for (std::size_t b = 0; b < model.bodies.size(); ++b)
        if (const std::string in = solid_set_of(model, b);
            !in.empty() && !solid_of(model, model.bodies[b])->rigid())
          needs.push_back({in, &fields::strain_energy});
      if (needs.empty()) needs.push_back({"solids", &fields::mass});
      return needs;
    }
    if (set == "soil")
      return {
          {"soil", &fields::stress}, {"soil", &fields::volume}, {"soil", &fields::plastic_work}};
    return {{"water", &fields::density}, {"water", &fields::mass}};
  }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    Energies e = set == "solids" ? Energies{}
                 : set == "soil" ? soil_energies(scene)
                                 : water_energies(scene);
    if (set == "solids") {
      const std::int32_t one = body.empty() ? -1 : body_index(scene.model(), body);
      for (std::size_t k = 0; scene.has_set(solid_set_name(k)); ++k)
        e = e + solid_energies(scene, solid_set_name(k), one);
      out[4] = contact_energy(scene, one);
      e.internal += *out[4];
    }
    if (set == "soil") out[4] = dissipated_energy(scene);
    out[0] = e.kinetic;
    out[1] = e.potential;
    out[2] = e.internal;
    out[3] = e.total();
  }
};

const Register<ProbeSpec, EnergyProbe> registered_energy{"energy"};

}  // namespace
}  // namespace sphgeo
