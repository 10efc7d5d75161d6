#include "deck/registry.h"
#include "materials/solid.h"

namespace sphgeo {

Schema<Rigid> Rigid::schema() {
  Schema<Rigid> s("rigid",
                  "solid that does not deform: it moves with the six degrees of freedom of its "
                  "body (three in 2D)");
  declare_solid_keys(s);
  s.optional("stiffness", &Rigid::stiffness, unit::pressure,
             "of its contacts with other solids and walls: the pressure at a penetration of about "
             "a spacing")
      .above(0)
      .equation("Eq. 79");
  return s;
}

static const Register<MaterialSpec, Rigid> registered_rigid{"rigid"};

}  // namespace sphgeo
