#include "core/parallel.h"
#include "core/text.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Force of water and soil on one boundary.
struct ForceProbe final : Probe {
  std::string boundary;

  static Schema<ForceProbe> schema() {
    Schema<ForceProbe> s("force", "force of water and soil on a boundary (Eqs. 70, 76, 77)");
    s.required("boundary", &ForceProbe::boundary, unit::none, "name of the boundary");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    return vector_columns(model, "f", model.dimension == 2 ? unit::stiffness : unit::force,
                          model.dimension == 2 ? "force per metre of depth" : "force");
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{"walls", &fields::wall_force}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const auto& all = scene.model().boundaries;
    std::int32_t wanted = -1;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k]->name == boundary) wanted = static_cast<std::int32_t>(k);
    if (wanted < 0 || !scene.has_set("walls")) return;
    const auto part = scene.tag("walls", fields::part);
    const auto force = scene.vector("walls", fields::wall_force);
    const Vec3 sum = ordered_sum(scene.size("walls"), [&](Index i) -> Vec3 {
      return part(i) == wanted ? force(i) : Vec3::Zero();
    });
    store_vector(scene, sum, out);
  }
};

const Register<ProbeSpec, ForceProbe> registered_force{"force"};

}  // namespace
}  // namespace sphgeo
