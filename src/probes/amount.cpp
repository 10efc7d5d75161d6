#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Number, mass and volume of a set.
struct AmountProbe final : Probe {
  std::string set = "water";

  // Field that gives the volume of the phase itself.
  const FieldSpec* own_field() const {
    return set == "water" ? &fields::density : set == "soil" ? &fields::volume_fraction : nullptr;
  }

  static Schema<AmountProbe> schema() {
    Schema<AmountProbe> s("amount", "number of particles, mass and volume of a set");
    s.optional("set", &AmountProbe::set, unit::none, "the particle set");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    const bool flat = model.dimension == 2;
    return {{"mass", flat ? "kg/m" : "kg", "mass"},
            {"volume", flat ? "m2" : "m3",
             "sum of the particles' volumes; for water in soil that of the mixture"},
            {"count", "1", "number of particles"},
            {"own_volume", flat ? "m2" : "m3",
             "sum of m / rho: of water without the soil, of soil without the pores"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    std::vector<FieldRequest> out{{set, &fields::mass}, {set, &fields::volume}};
    if (const FieldSpec* f = own_field()) out.push_back({set, f});
    return out;
  }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    const auto m = scene.scalar(set, fields::mass), volume = scene.scalar(set, fields::volume);
    out[0] = ordered_sum(scene.size(set), [&](Index i) { return m(i); });
    out[1] = ordered_sum(scene.size(set), [&](Index i) { return volume(i); });
    out[2] = static_cast<double>(scene.size(set));
    if (const FieldSpec* f = own_field()) {
      const auto own = scene.scalar(set, *f);
      out[3] = ordered_sum(scene.size(set), [&](Index i) {
        return f == &fields::density ? m(i) / own(i) : volume(i) * own(i);
      });
    } else {
      out[3] = out[1];
    }
  }
};

const Register<ProbeSpec, AmountProbe> registered_amount{"amount"};

}  // namespace
}  // namespace sphgeo
