#include <cmath>

#include "core/parallel.h"
#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Volume flow of a set through a plane, or through the part of it that lies in a box.
struct FluxProbe final : Probe {
  std::string set = "water";
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();
  std::optional<Vec3> region_min, region_max;

  // The volume of water is m / rho: the field `volume` is that of the mixture where there is soil.
  const FieldSpec* own_volume_field() const {
    return set == "water" ? &fields::density : &fields::volume;
  }

  static Schema<FluxProbe> schema() {
    Schema<FluxProbe> s("flux", "volume flow of a set through a plane");
    s.optional("set", &FluxProbe::set, unit::none, "the particle set");
    s.required("point", &FluxProbe::point, unit::length, "a point of the plane");
    s.required("normal", &FluxProbe::normal, unit::none,
               "normal of the plane; flow along it counts positive")
        .keep_y();
    s.optional("region_min", &FluxProbe::region_min, unit::length,
               "lower corner of the region considered");
    s.optional("region_max", &FluxProbe::region_max, unit::length,
               "upper corner of the region considered");
    s.check([](FluxProbe& p, CheckContext& c) {
      if (!(p.normal.norm() > 0))
        c.error("normal", "the normal has no length", "give a vector that is not zero");
      else p.normal.normalize();
    });
    return s;
  }
  std::vector<Column> columns(const Model& model) const override {
    const bool flat = model.dimension == 2;
    return {{"flow", flat ? "m2/s" : "m3/s",
             "volume per time through the plane: of water without the soil it flows in, of soil "
             "with its pores"},
            {"mass_flow", flat ? "kg/(m s)" : "kg/s", "mass per time through the plane"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{set, &fields::velocity}, {set, &fields::mass}, {set, own_volume_field()}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set)) return;
    const auto x = scene.vector(set, fields::position), v = scene.vector(set, fields::velocity);
    const auto m = scene.scalar(set, fields::mass), own = scene.scalar(set, *own_volume_field());
    const bool water = set == "water";
    const double width = 2 * scene.spacing(set);
    const bool flat = scene.dimension() == 2;
    // The plane as a hat function of unit area, two spacings to each side.
    const auto weight = [&](Index i) {
      const Vec3 p = x(i);
      const double share = 1 - std::abs((p - point).dot(normal)) / width;
      if (share <= 0) return 0.0;
      for (int k = 0; k < 3; ++k) {
        if (k == 1 && flat) continue;
        if ((region_min && p[k] < (*region_min)[k]) || (region_max && p[k] > (*region_max)[k]))
          return 0.0;
      }
      return v(i).dot(normal) * share / width;
    };
    out[0] = ordered_sum(scene.size(set),
                         [&](Index i) { return (water ? m(i) / own(i) : own(i)) * weight(i); });
    out[1] = ordered_sum(scene.size(set), [&](Index i) { return m(i) * weight(i); });
  }
};

const Register<ProbeSpec, FluxProbe> registered_flux{"flux"};

}  // namespace
}  // namespace sphgeo
