#include "deck/registry.h"
#include "materials/solid.h"

namespace sphgeo {

Schema<Elastic> Elastic::schema() {
  Schema<Elastic> s("elastic", "hyperelastic solid in total-Lagrangian form (Eqs. 35 to 40)");
  declare_solid_keys(s);
  s.required("youngs_modulus", &Elastic::youngs_modulus, unit::pressure, "Young's modulus E")
      .above(0);
  s.optional("poisson_ratio", &Elastic::poisson_ratio, unit::none, "Poisson's ratio nu")
      .above(-1)
      .below(0.5);
  s.optional("law", &Elastic::law, unit::none, "strain energy")
      .choices({"neo_hookean", "saint_venant_kirchhoff"})
      .equation("Eqs. 38 to 40");
  s.optional("damping", &Elastic::damping, unit::rate,
             "mass-proportional damping, -damping v, to bring a body to rest; 0 for free motion")
      .at_least(0);
  s.optional("viscosity_factor", &Elastic::viscosity_factor, unit::none,
             "artificial viscosity between particles, as a fraction of rho_0 c h: damps waves as "
             "short as the spacing, and others little; 0: none")
      .at_least(0)
      .at_most(1);
  return s;
}

static const Register<MaterialSpec, Elastic> registered_elastic{"elastic"};

}  // namespace sphgeo
