#include <Eigen/Geometry>
#include <array>

#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/solid_scene.h"

namespace sphgeo {
namespace {

/// Forces and torques on one solid by water, soil and contact.
struct BodyForceProbe final : Probe {
  std::string body;

  static Schema<BodyForceProbe> schema() {
    Schema<BodyForceProbe> s(
        "body_force",
        "force and torque on a solid by water, soil and contact (Eqs. 70, 75-79), means over the "
        "advection step; torques about its centre of mass");
    s.required("body", &BodyForceProbe::body, unit::none, "name of the body");
    return s;
  }

  struct Source {
    const char* name;
    const FieldSpec* field;
  };
  static constexpr std::array<Source, 3> sources{{{"water", &fields::mean_water_force},
                                                  {"soil", &fields::mean_soil_force},
                                                  {"contact", &fields::mean_contact_force}}};

  std::vector<Column> columns(const Model& model) const override {
    const bool flat = model.dimension == 2;
    std::vector<Column> out;
    for (const Source& source : sources) {
      for (const Column& c : vector_columns(
               model, std::string(source.name) + "_", flat ? unit::stiffness : unit::force,
               std::string("force of ") + source.name + (flat ? " per metre of depth" : "")))
        out.push_back(c);
      if (flat)
        out.push_back({std::string(source.name) + "_torque", "N",
                       std::string("torque of ") + source.name + " per metre of depth, about y"});
      else
        for (const Column& c :
             vector_columns(model, std::string(source.name) + "_torque_", unit::moment,
                            std::string("torque of ") + source.name))
          out.push_back(c);
    }
    return out;
  }
  void inspect(const Model& model, CheckContext& c) const override {
    inspect_body(model, body, "body", c);
  }
  std::vector<FieldRequest> needs(const Model& model) const override {
    std::vector<FieldRequest> needs{{set_of_body(model, body), &fields::mass}};
    for (const Source& source : sources) needs.push_back({"interface", source.field, true});
    return needs;
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const std::string set = set_of_body(scene.model(), body);
    if (!scene.has_set(set) || scene.time() == 0) return;  // no step, no mean
    const std::int32_t wanted = body_index(scene.model(), body);
    const auto m = scene.scalar(set, fields::mass);
    const auto at = scene.vector(set, fields::position);
    const auto of = scene.tag(set, fields::part);
    const auto share = [&](Index i) { return of(i) == wanted ? m(i) : 0.0; };
    const Vec3 moment =
        ordered_sum(scene.size(set), [&](Index i) -> Vec3 { return share(i) * at(i); });
    const Vec3 center = moment / ordered_sum(scene.size(set), [&](Index i) { return share(i); });
    const auto each = static_cast<std::size_t>(scene.dimension() == 2 ? 3 : 6);
    for (std::size_t k = 0; k < sources.size(); ++k) {
      Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
      if (scene.has_field("interface", *sources[k].field)) {
        const auto f = scene.vector("interface", *sources[k].field),
                   x = scene.vector("interface", fields::position);
        const auto part = scene.tag("interface", fields::part);
        const auto on = [&](Index i) -> Vec3 { return part(i) == wanted ? f(i) : Vec3::Zero(); };
        force = ordered_sum(scene.size("interface"), on);
        torque = ordered_sum(scene.size("interface"),
                             [&](Index i) -> Vec3 { return (x(i) - center).cross(on(i)); });
      }
      store_vector(scene, force, out, k * each);
      if (scene.dimension() == 2) out[k * each + 2] = torque.y();
      else store_vector(scene, torque, out, k * each + 3);
    }
  }
};

const Register<ProbeSpec, BodyForceProbe> registered_body_force{"body_force"};

}  // namespace
}  // namespace sphgeo
