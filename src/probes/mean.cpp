#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/text.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "geometry/shapes.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// A scalar field, or one component of another: "pressure", "velocity.x", "stress.xz".
struct Scalar {
  const FieldSpec* field = nullptr;  ///< null: there is none of that name
  int component = 0;

  explicit Scalar(const std::string& name) {
    const auto dot = name.find('.');
    const std::string of = name.substr(0, dot), part = dot == name.npos ? "" : name.substr(dot + 1);
    for (const FieldSpec* f : fields::all) {
      if (of != f->name) continue;
      const auto names = components(*f);
      const auto at = std::find(names.begin(), names.end(), part);
      if (at == names.end()) return;
      field = f;
      component = static_cast<int>(at - names.begin());
    }
  }
  /// Their names; that of a scalar is empty, tags have none.
  static std::vector<std::string> components(const FieldSpec& f) {
    switch (f.type) {
      case FieldType::scalar:
        return {""};
      case FieldType::vector:
        return {"x", "y", "z"};
      case FieldType::tensor:
        return {"xx", "yy", "zz", "xy", "yz", "xz"};
      default:
        return {};
    }
  }
  std::function<double(Index)> of(const SceneView& scene, const std::string& set) const {
    if (field->type == FieldType::scalar) return scene.scalar(set, *field);
    if (field->type == FieldType::vector)
      return [v = scene.vector(set, *field), k = component](Index i) { return v(i)[k]; };
    return [v = scene.tensor(set, *field), k = component](Index i) { return v(i)[k]; };
  }
};

/// Mean, smallest and largest value of a field over the particles in a region.
struct MeanProbe final : Probe {
  std::string set = "water";
  std::string field;
  std::shared_ptr<const Shape> region, over;

  static Schema<MeanProbe> schema() {
    Schema<MeanProbe> s(
        "mean", "mean, smallest and largest value of a field over the particles in a region");
    s.optional("set", &MeanProbe::set, unit::none, "the particle set");
    s.required("field", &MeanProbe::field, unit::none,
               "the field; of a vector or tensor one component, as velocity.x or stress.xz");
    s.optional("region", &MeanProbe::region, unit::none, "the region; auto: everywhere");
    s.optional("over", &MeanProbe::over, unit::none,
               "a second region, whose mean is the denominator of 'ratio'; auto: no ratio");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    const FieldSpec* f = Scalar(field).field;
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
    const FieldSpec* f = Scalar(field).field;
    return {{set, f ? f : &fields::mass}, {set, &fields::position}};
  }
  void inspect(const Model&, CheckContext& c) const override {
    if (Scalar(field).field) return;
    std::vector<std::string> names;
    for (const FieldSpec* f : fields::all)
      for (const std::string& part : Scalar::components(*f))
        names.push_back(f->name + (part.empty() ? "" : "." + part));
    const std::string near = suggestion(field, names);
    c.error("field", "there is no scalar field '" + field + "'",
            near.empty() ? "'sphgeo list fields' names them; of vectors and tensors give a "
                           "component, as velocity.x or stress.xz"
                         : near);
  }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const Scalar wanted(field);
    if (!wanted.field || !scene.has_set(set)) return;
    const auto value = wanted.of(scene, set);
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
