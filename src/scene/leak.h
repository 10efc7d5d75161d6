#pragma once
// Does the deck's water stay in the container that it starts in?

#include "scene/build.h"

namespace sphgeo {

/// W125: water (or another liquid phase) that starts between walls can run out through a gap of
/// about one spacing or more; names the position, the width and the nearest boundary. N126: it
/// starts at a face that the deck left open. N127: the scene has too many cells for this check. No
/// finding where nothing encloses it, where only splashes can reach an opening, and where it comes
/// to rest inside the scene.
template <int Dim>
void check_leaks(const Scene<Dim>& scene, Diagnostics& found);

extern template void check_leaks<2>(const Scene<2>&, Diagnostics&);
extern template void check_leaks<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
