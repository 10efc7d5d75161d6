#include "deck/interfaces.h"

#include "deck/schema.h"

namespace sphgeo {

Schema<MaterialSpec> MaterialSpec::common() {
  Schema<MaterialSpec> s("material", "Keys of every material.");
  s.required("name", &MaterialSpec::name, unit::none, "the name that bodies refer to");
  return s;
}

Schema<BoundarySpec> BoundarySpec::common() {
  Schema<BoundarySpec> s("boundary", "Keys of every boundary.");
  s.required("name", &BoundarySpec::name, unit::none, "the name of its particles and files");
  return s;
}

Schema<ProbeSpec> ProbeSpec::common() {
  Schema<ProbeSpec> s("probe", "Keys of every probe.");
  s.required("name", &ProbeSpec::name, unit::none,
             "the name of its file, and the name that 'expect' refers to");
  s.optional("every", &ProbeSpec::every, unit::time,
             "interval between samples; auto: end_time / 500")
      .above(0)
      .changeable_on_resume();
  return s;
}

}  // namespace sphgeo
