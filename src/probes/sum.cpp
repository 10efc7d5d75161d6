#include <algorithm>

#include "core/text.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Sum of other probes, column by column: the force on two walls, the difference of two pressures.
struct SumProbe final : Probe {
  std::vector<std::string> of;
  std::vector<double> factors;

  static Schema<SumProbe> schema() {
    Schema<SumProbe> s("sum", "sum of other probes of the deck, column by column");
    s.required("of", &SumProbe::of, unit::none,
               "names of the probes; they stand before this one and have the same columns")
        .items(1, 1000);
    s.optional("factors", &SumProbe::factors, unit::none,
               "what each is multiplied by, as [1, -1] for a difference; empty: 1 for all");
    s.check([](SumProbe& p, CheckContext& c) {
      if (!p.factors.empty() && p.factors.size() != p.of.size())
        c.error("factors", "there are " + std::to_string(p.of.size()) + " probes and " +
                               std::to_string(p.factors.size()) + " factors");
    });
    return s;
  }
  void inspect(const Model& model, CheckContext& c) const override {
    std::vector<std::string> names;
    for (const auto& p : model.probes) {
      if (p.get() == this) break;
      names.push_back(p->name);
    }
    const auto key = [](std::size_t k) { return "of[" + std::to_string(k) + "]"; };
    for (std::size_t k = 0; k < of.size(); ++k)
      if (std::find(names.begin(), names.end(), of[k]) == names.end()) {
        const bool later = std::any_of(model.probes.begin(), model.probes.end(),
                                       [&](const auto& p) { return p->name == of[k]; });
        c.error(key(k),
                later ? "probe '" + of[k] + "' does not stand before this one"
                      : "there is no probe '" + of[k] + "'",
                later ? "move it up" : suggestion(of[k], names, "probes before this one"));
        return;
      }
    const auto first = columns(model);
    for (std::size_t k = 1; k < of.size(); ++k) {
      const auto other = find(model, of[k])->columns(model);
      if (!std::equal(first.begin(), first.end(), other.begin(), other.end(),
                      [](const Column& a, const Column& b) {
                        return a.name == b.name && a.unit == b.unit;
                      }))
        c.error(key(k), "probe '" + of[k] + "' has other columns than probe '" + of[0] + "'",
                "add probes of one type");
      // Torques about two points make one about none; their sentences end with the point.
      else if (!std::equal(first.begin(), first.end(), other.begin(), other.end(),
                           [](const Column& a, const Column& b) {
                             const auto point = [](const std::string& text) {
                               return text.substr(std::min(text.rfind("about ("), text.size()));
                             };
                             return point(a.sentence) == point(b.sentence);
                           }))
        c.error(
            key(k),
            "probe '" + of[k] + "' takes torques about another point than probe '" + of[0] + "'",
            "give both the same 'about'");
    }
  }
  std::vector<Column> columns(const Model& model) const override {
    const Probe* first = find(model, of.front());
    std::vector<Column> columns = first ? first->columns(model) : std::vector<Column>{};
    for (Column& c : columns) c.sentence = "sum over " + in_words(of) + ": " + c.sentence;
    return columns;
  }
  /// The others ask for their fields themselves.
  std::vector<FieldRequest> needs(const Model&) const override { return {}; }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    for (std::size_t k = 0; k < of.size(); ++k) {
      std::vector<std::optional<double>> values(out.size());
      find(scene.model(), of[k])->sample(scene, values);
      const double factor = factors.empty() ? 1.0 : factors[k];
      for (std::size_t c = 0; c < out.size(); ++c)
        // Empty where one of them is.
        if (k > 0 && !out[c]) continue;
        else if (!values[c]) out[c].reset();
        else out[c] = out[c].value_or(0.0) + factor * *values[c];
    }
  }

 private:
  /// The probe of that name before this one, or nullptr.
  const Probe* find(const Model& model, const std::string& wanted) const {
    for (const auto& p : model.probes) {
      if (p.get() == this) break;
      if (p->name == wanted) return dynamic_cast<const Probe*>(p.get());
    }
    return nullptr;
  }
};

const Register<ProbeSpec, SumProbe> registered_sum{"sum"};

}  // namespace
}  // namespace sphgeo
