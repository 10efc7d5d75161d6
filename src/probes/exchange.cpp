#include <algorithm>

#include "boundaries/exchange.h"
#include "core/text.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Particles and mass that have crossed a boundary.
struct ExchangeProbe final : Probe {
  std::string boundary;

  static Schema<ExchangeProbe> schema() {
    Schema<ExchangeProbe> s(
        "exchange",
        "particles and mass that have entered or left through an inlet, a reservoir or an outlet");
    s.required("boundary", &ExchangeProbe::boundary, unit::none, "the name of the boundary");
    return s;
  }
  void inspect(const Model& model, CheckContext& c) const override {
    std::vector<std::string> names;
    for (const auto& b : model.boundaries)
      if (dynamic_cast<const ExchangeBoundary*>(b.get())) names.push_back(b->name);
    if (std::find(names.begin(), names.end(), boundary) == names.end())
      c.error("boundary", "there is no inlet, reservoir or outlet '" + boundary + "'",
              names.empty() ? "the deck has no inlet, reservoir or outlet"
                            : suggestion(boundary, names, "boundaries that particles cross"));
  }
  std::vector<Column> columns(const Model& model) const override {
    const char* kg = model.dimension == 2 ? "kg/m" : "kg";
    return {{"entered", "1", "particles that have entered since t = 0"},
            {"left", "1", "particles that have left since t = 0"},
            {"mass", kg, "mass that has entered since t = 0 minus the mass that has left"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override { return {}; }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const Crossings c = scene.crossings(boundary);
    out[0] = c.entered;
    out[1] = c.left;
    out[2] = c.mass;
  }
};

const Register<ProbeSpec, ExchangeProbe> registered_exchange{"exchange"};

}  // namespace
}  // namespace sphgeo
