#pragma once
// Rules of a deck about its boundaries.

#include "scene/build.h"

namespace sphgeo {

/// Findings about boundaries: damaged surfaces, boundaries without particles (E143), boxes that are
/// no multiple of the spacing (W122), particles deep in a solid (E121), walls that water and soil
/// pass (W149), inlets that are open behind (N153), probes inside a solid (W128), bodies without
/// any boundary below them (W129). Boundaries that overlap are joined.
template <int Dim>
void check_walls(const Scene<Dim>& scene, Diagnostics& found);

extern template void check_walls<2>(const Scene<2>&, Diagnostics&);
extern template void check_walls<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
