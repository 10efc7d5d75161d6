#pragma once
// The skin of solids: what water, soil, walls and other solids touch of them.

#include "scene/build.h"

namespace sphgeo {

/// Whether the solids of a deck can meet anything: water, soil, walls, each other or themselves.
bool has_skin(const Model& model);

/// How deep below the surface of a solid its skin reaches, m.
double skin_depth(const Model& model);

/// Adds the set "skin" where solids can meet something: a copy of their particles near the surface,
/// which follows them. It keeps their bodies as `part`, and knows them by set and id.
template <int Dim>
void add_skin(Scene<Dim>& scene, const Model& model, Filling filling);

extern template void add_skin<2>(Scene<2>&, const Model&, Filling);
extern template void add_skin<3>(Scene<3>&, const Model&, Filling);

}  // namespace sphgeo
