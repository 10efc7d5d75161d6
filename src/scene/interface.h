#pragma once
// Interface particles of solids: those that interact with water, soil, walls and other solids.

#include "scene/build.h"

namespace sphgeo {

/// Whether the solids of a deck can interact with water, soil, walls, each other or themselves.
bool has_interface(const Model& model);

/// Depth of the layer of interface particles below the surface of a solid, m.
double interface_depth(const Model& model);

/// Adds the set "interface" where solids can interact: copies of their particles near the surface,
/// which follow them. They keep the body as `part`, and refer to their particles by set and id.
template <int Dim>
void add_interface(Scene<Dim>& scene, const Model& model, Filling filling);

extern template void add_interface<2>(Scene<2>&, const Model&, Filling);
extern template void add_interface<3>(Scene<3>&, const Model&, Filling);

}  // namespace sphgeo
