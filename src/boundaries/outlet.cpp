#include "boundaries/exchange.h"
#include "deck/registry.h"

namespace sphgeo {

Schema<Outlet> Outlet::schema() {
  Schema<Outlet> s("outlet", "a region in which particles are removed and counted");
  s.required("shape", &Outlet::shape, unit::none,
             "the region; particles that enter it are removed after the advection step");
  s.optional("sets", &Outlet::sets, unit::none, "the particle sets that are removed")
      .choices({"water", "soil"});
  return s;
}

namespace {
const Register<BoundarySpec, Outlet> registered_outlet{"outlet"};
}
}  // namespace sphgeo
