#include "deck/registry.h"
#include "materials/solid.h"

namespace sphgeo {

Schema<Rigid> Rigid::schema() {
  Schema<Rigid> s("rigid", "rigid solid with six degrees of freedom (three in 2D)");
  declare_solid_keys(s);
  s.optional("stiffness", &Rigid::stiffness, unit::pressure,
             "stiffness of its contacts with other solids and walls: the pressure at a penetration "
             "of about a spacing")
      .above(0)
      .equation("Eq. 79");
  return s;
}

static const Register<MaterialSpec, Rigid> registered_rigid{"rigid"};

}  // namespace sphgeo
