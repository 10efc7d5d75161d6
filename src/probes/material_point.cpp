#include <Eigen/LU>

#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/solid_scene.h"

namespace sphgeo {
namespace {

/// Displacement and velocity of a point that belongs to a solid.
struct MaterialPointProbe final : Probe {
  std::string body;
  Vec3 at = Vec3::Zero();

  static Schema<MaterialPointProbe> schema() {
    Schema<MaterialPointProbe> s(
        "material_point",
        "displacement and velocity of a material point of a solid, given by its reference "
        "position; a linear fit to the particles around it");
    s.required("body", &MaterialPointProbe::body, unit::none, "name of the body");
    s.required("at", &MaterialPointProbe::at, unit::length, "position of the point at t = 0");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    auto columns = vector_columns(model, "u", unit::length, "displacement");
    for (const Column& c : vector_columns(model, "v", unit::speed, "velocity"))
      columns.push_back(c);
    return columns;
  }
  std::vector<FieldRequest> needs(const Model& model) const override {
    return {{set_of_body(model, body), &fields::reference_position},
            {set_of_body(model, body), &fields::velocity}};
  }
  void inspect(const Model& model, CheckContext& c) const override {
    inspect_body(model, body, "body", c);
  }
  std::vector<Vec3> positions() const override { return {at}; }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const std::string set = set_of_body(scene.model(), body);
    if (!scene.has_set(set)) return;
    const std::int32_t wanted = body_index(scene.model(), body);
    const auto part = scene.tag(set, fields::part);
    const auto reference = scene.vector(set, fields::reference_position),
               x = scene.vector(set, fields::position);
    const auto v = scene.vector(set, fields::velocity);
    const double h = scene.smoothing_length(set), reach = 4 * h * h;
    // Weighted fit a + b . (X - at), exact for linear fields: also at the end of a bar.
    Eigen::Matrix4d moment = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 6> right = Eigen::Matrix<double, 4, 6>::Zero();
    Index count = 0;
    for (Index i = 0; i < scene.size(set); ++i) {
      const Vec3 d = (reference(i) - at) / h;
      if (part(i) != wanted || d.squaredNorm() * h * h >= reach) continue;
      const double s = 1 - 0.5 * d.norm(), w = s * s * s * s * (2 * d.norm() + 1);
      Eigen::Vector4d row;
      row << 1, d;
      Eigen::Matrix<double, 6, 1> values;
      values << x(i) - reference(i), v(i);
      moment += w * row * row.transpose();
      right += w * row * values.transpose();
      ++count;
    }
    if (count < scene.dimension() + 1) return;
    if (scene.dimension() == 2) moment(2, 2) += 1;  // no variation normal to the plane
    const Eigen::FullPivLU<Eigen::Matrix4d> inverse(moment);
    const Eigen::Matrix<double, 1, 6> fit =
        inverse.rcond() > 1e-6 ? Eigen::Matrix<double, 1, 6>(inverse.solve(right).row(0))
                               : Eigen::Matrix<double, 1, 6>(right.row(0) / moment(0, 0));
    store_vector(scene, fit.head<3>().transpose(), out);
    store_vector(scene, fit.tail<3>().transpose(), out,
                 static_cast<std::size_t>(scene.dimension()));
  }
};

const Register<ProbeSpec, MaterialPointProbe> registered_material_point{"material_point"};

}  // namespace
}  // namespace sphgeo
