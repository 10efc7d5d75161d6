#include <array>
#include <cmath>

#include "deck/registry.h"
#include "deck/schema.h"
#include "materials/soil.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// One material point of soil on a prescribed deformation path, without particles.
struct StressPathProbe final : Probe {
  std::string material;
  std::string path;
  double rate = 1;
  double step = 1e-3;
  double pressure = 0;
  std::optional<std::vector<Expression>> gradient;

  static Schema<StressPathProbe> schema() {
    Schema<StressPathProbe> s(
        "stress_path",
        "a material point of soil on a prescribed deformation path, without particles");
    s.required("material", &StressPathProbe::material, unit::none,
               "name of a material of type soil");
    s.required("path", &StressPathProbe::path, unit::none,
               "oedometric: compression along z without lateral strain; triaxial: with constant "
               "lateral stress; simple_shear: "
               "dv_x/dz; gradient: the given velocity gradient")
        .choices({"oedometric", "triaxial", "simple_shear", "gradient"});
    s.optional("rate", &StressPathProbe::rate, unit::rate, "rate of compression or shear");
    s.optional("step", &StressPathProbe::step, unit::time, "time step of the stress update")
        .above(0);
    s.optional("pressure", &StressPathProbe::pressure, unit::pressure, "initial isotropic pressure")
        .at_least(0);
    s.optional("gradient", &StressPathProbe::gradient, unit::rate,
               "for path: gradient: dv_x/dx, dv_x/dy, dv_x/dz, dv_y/dx ... dv_z/dz, formulas of t")
        .items(9, 9)
        .only_of("t");
    s.check([](StressPathProbe& p, CheckContext& c) {
      if (p.gradient.has_value() != (p.path == "gradient"))
        c.error("gradient", "'gradient' belongs to path: gradient, which needs it");
    });
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"xx", "Pa", "stress, tension positive"},
            {"yy", "Pa", "stress"},
            {"zz", "Pa", "stress"},
            {"xy", "Pa", "stress"},
            {"yz", "Pa", "stress"},
            {"xz", "Pa", "stress"},
            {"pressure", "Pa", "mean pressure, compression positive"},
            {"root_j2", "Pa", "sqrt(J2)"},
            {"outside", "1",
             "largest distance outside of the yield surface since t = 0, over k_c or the mean "
             "pressure"},
            {"plastic_strain", "1", "equivalent plastic strain"},
            {"plastic_work", "J/m3", "plastic work per volume"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override { return {}; }
  void inspect(const Model& model, CheckContext& c) const override {
    if (!dynamic_cast<const Soil*>(model.material(material)))
      c.error("material", "there is no soil material '" + material + "'",
              "name an entry of 'materials' that is of type soil", "E021");
  }

  // A sample starts at t = 0 again: the probe keeps nothing between samples.
  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    const auto* soil = dynamic_cast<const Soil*>(scene.model().material(material));
    if (!soil) return;
    const DruckerPrager<double> m = soil->constants();
    double s[6] = {-pressure, -pressure, -pressure, 0, 0, 0}, strain = 0, work = 0, outside = 0;
    const auto steps = static_cast<Index>(std::floor(scene.time() / step + 1e-9));
    for (Index k = 0; k < steps; ++k) {
      double g[3][3] = {};
      lead((static_cast<double>(k) + 0.5) * step, m, s, g);
      const PlasticStep<double> plastic = update_stress(s, g, step, m);
      strain += plastic.strain;
      work += plastic.work;
      const StressInvariants<double> now(s);
      const double f = m.friction * now.first + std::sqrt(now.second) - m.strength;
      outside = std::max(outside, f / std::max({m.strength, std::abs(now.first) / 3, 1e-300}));
    }
    const StressInvariants<double> now(s);
    for (std::size_t k = 0; k < 6; ++k) out[k] = s[k];
    out[6] = -now.first / 3;
    out[7] = std::sqrt(now.second);
    out[8] = outside;
    out[9] = strain;
    out[10] = work;
  }

 private:
  // The velocity gradient of the step around time t.
  void lead(double t, const DruckerPrager<double>& m, const double (&s)[6],
            double (&g)[3][3]) const {
    if (path == "simple_shear") g[0][2] = rate;
    if (path == "oedometric" || path == "triaxial") g[2][2] = -rate;
    if (path == "triaxial") g[0][0] = g[1][1] = lateral_rate(m, s);
    if (path == "gradient")
      for (std::size_t k = 0; k < 9; ++k) g[k / 3][k % 3] = (*gradient)[k](Vec3::Zero(), t);
  }
  // The lateral strain rate that keeps the lateral stress constant, by bisection: the stress after
  // the step grows with it. The bracket is from no volume change of a dilating soil to no lateral
  // strain.
  double lateral_rate(const DruckerPrager<double>& m, const double (&s)[6]) const {
    double lo = -std::abs(rate), hi = 10 * std::abs(rate);
    for (int n = 0; n < 80; ++n) {
      const double middle = 0.5 * (lo + hi);
      double trial[6];
      std::copy(std::begin(s), std::end(s), trial);
      const double g[3][3] = {{middle, 0, 0}, {0, middle, 0}, {0, 0, -rate}};
      update_stress(trial, g, step, m);
      (trial[0] > -pressure ? hi : lo) = middle;
    }
    return 0.5 * (lo + hi);
  }
};

const Register<ProbeSpec, StressPathProbe> registered_stress_path{"stress_path"};

}  // namespace
}  // namespace sphgeo
