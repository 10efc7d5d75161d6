// STL files: the reader, welding, the checks of the surface and its distance.

#include <cmath>

#include "core/error.h"
#include "geometry/shapes.h"
#include "geometry/stl_file.h"
#include "targets.h"

namespace sphgeo::fuzz {

void run_stl(std::string_view input) {
  const MemoryFile file(input);
  for (const bool flat : {false, true})
    for (const std::optional<double> tolerance :
         {std::optional<double>(), std::optional(1e-30), std::optional(0.1)}) {
      Stl stl;
      stl.file.path = file.path();
      stl.flat = flat;
      stl.weld_tolerance = tolerance;
      try {
        stl.prepare();
      } catch (const Error&) {
        continue;
      }
      const Aabb box = stl.box();
      require(!box.empty() && box.lo.allFinite() && box.hi.allFinite(),
              "a surface has a finite box");
      Diagnostics found;
      const Places nowhere;
      CheckContext context(found, nowhere, "shape", flat ? 2 : 3);
      stl.inspect(context);
      for (const Vec3& at : {Vec3(0.1, 0, 0.2), Vec3(box.lo), Vec3(0.5 * (box.lo + box.hi))})
        require(!std::isnan(stl.signed_distance(at)), "the distance to a surface is a number");
    }
}

}  // namespace sphgeo::fuzz
