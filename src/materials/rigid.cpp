#include "deck/registry.h"
#include "materials/solid.h"

namespace sphgeo {

Schema<Rigid> Rigid::schema() {
  Schema<Rigid> s("rigid", "solid that does not deform: it moves with the six degrees of freedom of its body (three in 2D)");
  s.required("density", &Rigid::density, unit::density, "density").above(0);
  s.optional("stiffness", &Rigid::stiffness, unit::pressure,
             "of its contacts with other solids and walls: the pressure at a penetration of about a spacing").above(0).equation("Eq. 79");
  s.optional("slip", &Rigid::slip, unit::none, "whether water and soil stick to its surface or slide along it").choices({"no_slip", "free_slip"});
  return s;
}

static const Register<MaterialSpec, Rigid> registered{"rigid"};

}  // namespace sphgeo
