#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Centre and extent of a set as those of an ellipse or ellipsoid with the same second moments.
struct MomentsProbe final : Probe {
  std::string set = "water";

  static Schema<MomentsProbe> schema() {
    Schema<MomentsProbe> s("moments",
                           "centre of mass, semi-axes along the coordinates, and the area or "
                           "volume of the ellipse or ellipsoid with the same second moments");
    s.optional("set", &MomentsProbe::set, unit::none, "the particle set");
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    auto columns = vector_columns(model, "semi_axis_", unit::length, "semi-axis");
    for (const Column& c : vector_columns(model, "center_", unit::length, "centre of mass"))
      columns.push_back(c);
    columns.push_back(
        {"area", model.dimension == 2 ? "m2" : "m3", "area (volume in 3D) of that ellipse"});
    return columns;
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{set, &fields::mass}, {set, &fields::position}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set) || scene.size(set) == 0) return;
    const int dim = scene.dimension();
    const auto m = scene.scalar(set, fields::mass);
    const auto x = scene.vector(set, fields::position);
    const Index n = scene.size(set);
    const double mass = ordered_sum(n, [&](Index i) { return m(i); });
    const Vec3 center = ordered_sum(n, [&](Index i) -> Vec3 { return m(i) * x(i); }) / mass;
    Mat3 second = ordered_sum(n,
                              [&](Index i) -> Mat3 {
                                const Vec3 d = x(i) - center;
                                return m(i) * d * d.transpose();
                              }) /
                  mass;
    // A particle is a cell of its own size, with a second moment of dp^2/12 along each axis.
    second.diagonal().array() += scene.spacing(set) * scene.spacing(set) / 12;
    if (dim == 2) second(1, 1) = 1;
    // For a uniform ellipse <x^2> = a^2 / 4, for an ellipsoid a^2 / 5.
    const double factor = dim + 2;
    store_vector(scene, (factor * second.diagonal()).cwiseSqrt(), out);
    store_vector(scene, center, out, static_cast<std::size_t>(dim));
    const double unit_ball = dim == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
    out[2 * static_cast<std::size_t>(dim)] =
        unit_ball * std::sqrt(std::pow(factor, dim) * second.determinant());
  }
};

const Register<ProbeSpec, MomentsProbe> registered_moments{"moments"};

}  // namespace
}  // namespace sphgeo
