#pragma once
// Particles of solids and their state at t = 0.

#include "scene/build.h"

namespace sphgeo {

/// Adds a set for every spacing of solids with all bodies of it, and marks their clamped parts.
/// Findings that need particles go to `found`. With Filling::none the sets are made and stay empty.
template <int Dim>
void add_solids(Scene<Dim>& scene, const Model& model, Filling filling, Diagnostics& found);

extern template void add_solids<2>(Scene<2>&, const Model&, Filling, Diagnostics&);
extern template void add_solids<3>(Scene<3>&, const Model&, Filling, Diagnostics&);

}  // namespace sphgeo
