#include "boundaries/exchange.h"
#include "deck/registry.h"

namespace sphgeo {

Schema<Outlet> Outlet::schema() {
  Schema<Outlet> s("outlet", "a region in which particles are taken out of the scene, and counted");
  s.required("shape", &Outlet::shape, unit::none,
             "the region; what enters it is gone after the advection step");
  s.optional("sets", &Outlet::sets, unit::none, "the sets that leave").choices({"water", "soil"});
  return s;
}

namespace {
const Register<BoundarySpec, Outlet> registered_outlet{"outlet"};
}
}  // namespace sphgeo
