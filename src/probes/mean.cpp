#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "geometry/shapes.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// The scalar field of that name, or nullptr.
const FieldSpec* scalar_field(const std::string& name) {
  for (const FieldSpec* f : fields::all)
    if (f->type == FieldType::scalar && name == f->name) return f;
  return nullptr;
}

/// Mean, smallest and largest value of a field over the particles in a region.
struct MeanProbe final : Probe {
  std::string set = "water";
  std::string field;
  std::shared_ptr<const Shape> region, over;

  static Schema<MeanProbe> schema() {
    Schema<MeanProbe> s(
        "mean",
        "mean, smallest and largest value of a scalar field over the particles in a region");
    s.optional("set", &MeanProbe::set, unit::none, "the particle set");
    s.required("field", &MeanProbe::field, unit::none, "the scalar field");
    s.optional("region", &MeanProbe::region, unit::none, "the region; auto: everywhere");
    s.optional("over", &MeanProbe::over, unit::none,
               "a second region, whose mean is the denominator of 'ratio'; auto: no ratio");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    const FieldSpec* f = scalar_field(field);
    const std::string in = f ? f->unit.symbol : "1";
    std::vector<Column> out{
        {"mean", in, "mean over the particles in the region; empty without particles"},
        {"least", in, "smallest value"},
        {"largest", in, "largest value"},
        {"count", "1", "number of particles in the region"}};
    if (over) out.push_back({"ratio", "1", "mean over the mean in the second region"});
    return out;
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    const FieldSpec* f = scalar_field(field);
    return {{set, f ? f : &fields::mass}, {set, &fields::position}};
  }
  void inspect(const Model&, CheckContext& c) const override {
    if (!scalar_field(field))
      c.error("field", "there is no scalar field '" + field + "'",
              "'sphgeo list fields' names them");
  }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const FieldSpec* f = scalar_field(field);
    if (!f || !scene.has_set(set)) return;
    const auto value = scene.scalar(set, *f);
    const auto x = scene.vector(set, fields::position);
    const auto mean_in = [&](const std::shared_ptr<const Shape>& shape, double& count) {
      const auto in = [&](Index i) { return !shape || shape->signed_distance(x(i)) < 0; };
      count = ordered_sum(scene.size(set), [&](Index i) { return in(i) ? 1.0 : 0.0; });
      return ordered_sum(scene.size(set), [&](Index i) { return in(i) ? value(i) : 0.0; }) / count;
    };
    double count = 0;
    const double mean = mean_in(region, count);
    out[3] = count;
    if (count == 0) return;
    out[0] = mean;
    const auto kept = [&](Index i) { return !region || region->signed_distance(x(i)) < 0; };
    out[1] = block_min(scene.size(set), [&](Index i) { return kept(i) ? value(i) : INFINITY; });
    out[2] = block_max(scene.size(set), [&](Index i) { return kept(i) ? value(i) : -INFINITY; });
    if (!over) return;
    const double other = mean_in(over, count);
    if (count > 0) out[4] = mean / other;
  }
};

const Register<ProbeSpec, MeanProbe> registered_mean{"mean"};

}  // namespace
}  // namespace sphgeo
