#include <cmath>

#include "deck/registry.h"
#include "deck/schema.h"
#include "materials/drucker_prager.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// State of the soil at a fixed point.
struct StressProbe final : Probe {
  Vec3 at = Vec3::Zero();

  static Schema<StressProbe> schema() {
    Schema<StressProbe> s("stress",
                          "effective stress, plastic strain and volume fraction of the soil at a "
                          "fixed point, by a linear fit to the soil around it");
    s.required("at", &StressProbe::at, unit::length, "the point; it may lie on a wall");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"xx", "Pa", "stress, tension positive; empty where there is no soil"},
            {"yy", "Pa", "stress"},
            {"zz", "Pa", "stress"},
            {"xy", "Pa", "stress"},
            {"yz", "Pa", "stress"},
            {"xz", "Pa", "stress"},
            {"pressure", "Pa", "mean effective pressure, compression positive"},
            {"deviator", "Pa", "sqrt(3 J2)"},
            {"plastic_strain", "1", "equivalent plastic strain"},
            {"volume_fraction", "1", "volume fraction of the grains"},
            {"support", "1", "share of the kernel filled with soil"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{"soil", &fields::stress},
            {"soil", &fields::volume},
            {"soil", &fields::plastic_strain},
            {"soil", &fields::volume_fraction}};
  }
  std::vector<Vec3> positions() const override { return {at}; }
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const PointFit fit(scene, "soil", at);
    out[10] = fit.support();
    if (!fit.supported()) return;
    const auto stress = scene.tensor("soil", fields::stress);
    double s[6];
    for (int k = 0; k < 6; ++k) {
      s[k] = fit(std::function<double(Index)>([&](Index i) { return stress(i)[k]; }));
      out[static_cast<std::size_t>(k)] = s[k];
    }
    const StressInvariants<double> invariants(s);
    out[6] = -invariants.first / 3;
    out[7] = std::sqrt(3 * invariants.second);
    out[8] = fit(scene.scalar("soil", fields::plastic_strain));
    out[9] = fit(scene.scalar("soil", fields::volume_fraction));
  }
};

const Register<ProbeSpec, StressProbe> registered_stress{"stress"};

}  // namespace
}  // namespace sphgeo
