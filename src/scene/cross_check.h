#pragma once
// Rules of a deck that need its particles: overlaps, lengths against the spacing, probes outside,
// leaks.

#include "scene/build.h"

namespace sphgeo {

/// Findings about a built scene: bodies that overlap each other or a wall, lengths that are no
/// multiple of the spacing, probes outside of the scene, shapes with a damaged surface.
template <int Dim>
void check_scene(const Scene<Dim>& scene, Diagnostics& found);

extern template void check_scene<2>(const Scene<2>&, Diagnostics&);
extern template void check_scene<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
