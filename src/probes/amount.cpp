#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// How much of a set there is.
struct AmountProbe final : Probe {
  std::string set = "water";

  static Schema<AmountProbe> schema() {
    Schema<AmountProbe> s("amount", "number of particles, mass and volume of a set");
    s.optional("set", &AmountProbe::set, unit::none, "the particle set");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    const bool flat = model.dimension == 2;
    return {{"mass", flat ? "kg/m" : "kg", "mass"},
            {"volume", flat ? "m2" : "m3", "sum of m / rho"},
            {"count", "1", "number of particles"}};
  }
  std::vector<FieldRequest> needs() const override { return {{set, &fields::mass}, {set, &fields::volume}}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    const auto m = scene.scalar(set, fields::mass), volume = scene.scalar(set, fields::volume);
    out[0] = ordered_sum(scene.size(set), [&](Index i) { return m(i); });
    out[1] = ordered_sum(scene.size(set), [&](Index i) { return volume(i); });
    out[2] = static_cast<double>(scene.size(set));
  }
};

const Register<ProbeSpec, AmountProbe> registered{"amount"};

}  // namespace
}  // namespace sphgeo
