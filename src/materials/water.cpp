#include "materials/water.h"

#include "deck/registry.h"

namespace sphgeo {

Schema<Water> Water::schema() {
  Schema<Water> s("water", "weakly compressible Newtonian water, p = c0^2 (rho - rho0) (Eq. 26)");
  s.optional("density", &Water::density, unit::density, "density rho0 at zero pressure").above(0);
  s.optional("viscosity", &Water::viscosity, unit::viscosity,
             "dynamic viscosity eta (Eq. 28); 0 = inviscid")
      .at_least(0);
  s.optional("sound_speed", &Water::sound_speed, unit::speed,
             "artificial speed of sound c0; default: ten times max_speed, which keeps density "
             "changes near 1 %")
      .above(0);
  s.optional("max_speed", &Water::max_speed, unit::speed,
             "largest expected speed; default: estimated from heights, initial speeds and moving "
             "boundaries")
      .above(0);
  return s;
}

static const Register<MaterialSpec, Water> registered_water{"water"};

}  // namespace sphgeo
