#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "boundaries/boundary.h"
#include "core/parallel.h"
#include "core/text.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Force and torque of water and soil on one boundary.
struct ForceProbe final : Probe {
  std::string boundary;
  Vec3 about = Vec3::Zero();

  static Schema<ForceProbe> schema() {
    Schema<ForceProbe> s("force",
                         "force and torque of water and soil on a boundary, means over the "
                         "advection step (Eqs. 70, 76, 77)");
    s.required("boundary", &ForceProbe::boundary, unit::none, "name of the boundary");
    s.optional("about", &ForceProbe::about, unit::length,
               "the point, fixed in space, that torques are taken about");
    return s;
  }
  void inspect(const Model& model, CheckContext& c) const override {
    std::vector<std::string> names;
    for (const auto& b : model.boundaries)
      if (dynamic_cast<const WallBoundary*>(b.get())) names.push_back(b->name);
    if (std::find(names.begin(), names.end(), boundary) == names.end())
      c.error("boundary", "there is no boundary '" + boundary + "' that is made of walls",
              names.empty() ? "the deck has no walls" : suggestion(boundary, names, "walls"));
  }
  std::vector<Column> columns(const Model& model) const override {
    const bool flat = model.dimension == 2;
    auto columns = vector_columns(model, "f", flat ? unit::stiffness : unit::force,
                                  flat ? "force per metre of depth" : "force");
    const std::string point =
        fmt::format("about ({:.6g}, {:.6g}, {:.6g}) m", about.x(), about.y(), about.z());
    if (flat) columns.push_back({"torque", "N", "torque per metre of depth around y, " + point});
    else
      for (const Column& c : vector_columns(model, "torque_", unit::moment, "torque " + point))
        columns.push_back(c);
    return columns;
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{"walls", &fields::part},
            {"walls", &fields::mean_water_force, true},
            {"walls", &fields::mean_soil_force, true}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set("walls") || scene.time() == 0) return;  // no step, no mean
    const auto& all = scene.model().boundaries;
    const auto wanted = static_cast<std::int32_t>(
        std::find_if(all.begin(), all.end(), [&](const auto& b) { return b->name == boundary; }) -
        all.begin());
    const auto part = scene.tag("walls", fields::part);
    const auto x = scene.vector("walls", fields::position);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const FieldSpec* field : {&fields::mean_water_force, &fields::mean_soil_force}) {
      if (!scene.has_field("walls", *field)) continue;
      const auto f = scene.vector("walls", *field);
      const auto on = [&](Index i) -> Vec3 { return part(i) == wanted ? f(i) : Vec3::Zero(); };
      force += ordered_sum(scene.size("walls"), on);
      torque += ordered_sum(scene.size("walls"),
                            [&](Index i) -> Vec3 { return (x(i) - about).cross(on(i)); });
    }
    store_vector(scene, force, out);
    const auto first = static_cast<std::size_t>(scene.dimension());
    if (scene.dimension() == 2) out[first] = torque.y();
    else store_vector(scene, torque, out, first);
  }
};

const Register<ProbeSpec, ForceProbe> registered_force{"force"};

}  // namespace
}  // namespace sphgeo
