#include "materials/soil.h"

#include <cmath>
#include <utility>

#include "deck/registry.h"

namespace sphgeo {

Schema<Soil> Soil::schema() {
  Schema<Soil> s(
      "soil", "elastic, perfectly plastic soil skeleton after Drucker and Prager (Eqs. 12 to 21)");
  s.required("density", &Soil::density, unit::density,
             "density of the grains, rho^s; with volume_fraction 1 that of the bulk")
      .above(0);
  s.optional("volume_fraction", &Soil::volume_fraction, unit::none,
             "volume fraction of the grains at t = 0; auto: given by each body")
      .above(0)
      .at_most(1)
      .equation("Eq. 1");
  s.optional("youngs_modulus", &Soil::youngs_modulus, unit::pressure,
             "Young's modulus E of the skeleton; auto: it does not deform and nothing but water "
             "touches it (skeleton: fixed)")
      .above(0);
  s.optional("poisson_ratio", &Soil::poisson_ratio, unit::none,
             "Poisson's ratio nu of the skeleton")
      .above(-1)
      .below(0.5);
  s.optional("plasticity", &Soil::plasticity, unit::none,
             "yield criterion, or none for an elastic soil")
      .choices({"drucker_prager", "none"});
  s.optional("friction_angle", &Soil::friction_angle, unit::angle, "internal friction angle phi")
      .at_least(0)
      .below(1.5)
      .equation("Eq. 14");
  s.optional("friction", &Soil::friction, unit::none,
             "internal friction coefficient mu = tan phi, instead of the angle")
      .at_least(0);
  s.optional("cohesion", &Soil::cohesion, unit::pressure, "cohesion c")
      .at_least(0)
      .equation("Eq. 14");
  s.optional("saturated_cohesion", &Soil::saturated_cohesion, unit::pressure,
             "cohesion at full saturation, linear in the degree of saturation; auto: cohesion does "
             "not depend on saturation")
      .at_least(0)
      .equation("Eq. 108");
  s.optional("dilation_angle", &Soil::dilation_angle, unit::angle, "dilation angle psi")
      .at_least(0)
      .below(1.5)
      .equation("Eq. 14");
  s.optional("cone", &Soil::cone, unit::none,
             "stress path in which the cone matches Mohr and Coulomb: plane strain, as in Eq. 14, "
             "or triaxial compression or extension; in 3D the first underestimates the strength in "
             "triaxial compression (30 deg act as 21)")
      .choices({"plane_strain", "compression", "extension"})
      .equation("Eq. 14");
  s.optional("drag", &Soil::drag, unit::none,
             "drag of water in the soil; auto: darcy with a hydraulic_conductivity, ergun with a "
             "grain_size, else none")
      .choices({"auto", "ergun", "darcy", "none"});
  s.optional("grain_size", &Soil::grain_size, unit::length,
             "characteristic grain size D_c of Ergun's drag, usually D50")
      .above(0)
      .equation("Eq. 31");
  s.optional("hydraulic_conductivity", &Soil::hydraulic_conductivity, unit::speed,
             "hydraulic conductivity K^s of Darcy's drag")
      .above(0)
      .equation("Eq. 29");
  s.optional("drag_viscous", &Soil::drag_viscous, unit::none,
             "coefficient alpha_d of Ergun's viscous term")
      .at_least(0)
      .equation("Eq. 31");
  s.optional("drag_inertial", &Soil::drag_inertial, unit::none,
             "coefficient beta_d of Ergun's inertial term")
      .at_least(0)
      .equation("Eq. 31");
  s.optional("skeleton", &Soil::skeleton, unit::none,
             "deformable; fixed: it never moves; prescribed: it keeps the velocity field of its "
             "bodies, independent of stress")
      .choices({"deformable", "fixed", "prescribed"});
  s.check([](Soil& m, CheckContext& c) {
    if (m.drag == "ergun" && !m.grain_size)
      c.error("drag", "Ergun's drag needs a grain size",
              "give grain_size, as in 'grain_size: 2 mm'");
    if (m.drag == "darcy" && !m.hydraulic_conductivity)
      c.error("drag", "Darcy's drag needs a hydraulic conductivity",
              "give hydraulic_conductivity, as in 'hydraulic_conductivity: 1e-3 m/s'");
    if (m.drag == "auto" && m.grain_size && m.hydraulic_conductivity)
      c.error("hydraulic_conductivity",
              "grain_size and hydraulic_conductivity belong to two drag laws",
              "give one of them, or choose with 'drag: ergun' or 'drag: darcy'");
    if (m.skeleton != "fixed" && !m.youngs_modulus)
      c.error("", "missing key 'youngs_modulus': stresses arise in a skeleton that moves",
              "give it, as in 'youngs_modulus: 10 MPa', or 'skeleton: fixed' for soil that stays "
              "where it is",
              "E011");
    if (m.elastic()) {
      // By value: a resolved deck, which may be run again, has every key.
      const std::pair<const char*, bool> plastic[] = {
          {"friction_angle", m.friction_angle.has_value()},
          {"friction", m.friction.has_value()},
          {"cohesion", m.cohesion != 0},
          {"saturated_cohesion", m.saturated_cohesion.has_value()},
          {"dilation_angle", m.dilation_angle != 0}};
      for (const auto& [key, set] : plastic)
        if (set)
          c.error(key, std::string("'") + key + "' has no meaning without plasticity",
                  "leave it out, or leave 'plasticity: none' out");
      return;
    }
    if (m.friction_angle && m.friction)
      c.error("friction", "the friction is given twice",
              "give friction_angle or friction, not both");
    if (m.skeleton != "fixed" && !m.friction_angle && !m.friction)
      c.error("", "the soil has no friction",
              "give friction_angle (0 deg is allowed) or friction, or plasticity: none");
    // With more dilation than friction plastic flow would produce energy.
    if (std::tan(m.dilation_angle) > m.tan_friction() * (1 + 1e-12))
      c.error("dilation_angle", "the dilation angle exceeds the friction angle",
              "the plastic work would be negative");
    if (m.saturated_cohesion && *m.saturated_cohesion > m.cohesion)
      c.error("saturated_cohesion", "the saturated cohesion exceeds the cohesion",
              "saturation reduces cohesion");
  });
  return s;
}

double Soil::tan_friction() const {
  return friction ? *friction : std::tan(friction_angle.value_or(0));
}

DruckerPrager<double> Soil::constants(double saturation) const {
  DruckerPrager<double> m{bulk_modulus(), shear_modulus(), 0, 0, 0, 0};
  if (elastic()) return with_strength(m, drucker_prager::unbounded);
  const double dry = cohesion, wet = saturated_cohesion.value_or(cohesion);
  using drucker_prager::ConeFit;
  const ConeFit edge = cone == "compression" ? ConeFit::compression
                       : cone == "extension" ? ConeFit::extension
                                             : ConeFit::plane_strain;
  m.friction = drucker_prager::slope(tan_friction(), edge);
  m.dilation = drucker_prager::slope(std::tan(dilation_angle), edge);
  return with_strength(
      m, drucker_prager::strength(wet + (1 - saturation) * (dry - wet), tan_friction(), edge));
}

double Soil::pressure_at_rest() const {
  if (elastic()) return poisson_ratio / (1 - poisson_ratio);
  return 1 - std::sin(std::atan(tan_friction()));
}

static const Register<MaterialSpec, Soil> registered_soil{"soil"};

}  // namespace sphgeo
