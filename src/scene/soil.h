#pragma once
// Soil particles and their initial state.

#include <vector>

#include "scene/body_filling.h"
#include "scene/build.h"

namespace sphgeo {

/// Whether a body of soil is in the deck.
bool has_soil(const Model& model);

/// Adds the set "soil" with all bodies of soil, their mass, volume fraction and initial stress.
/// Findings that need particles go to `found`. With Filling::none the set is made and stays empty.
/// Returns the density at rest of the skeleton of each body of the deck, kg/m3; 0 of what is no
/// soil.
template <int Dim>
std::vector<double> add_soil(Scene<Dim>& scene, const Model& model, Filling filling,
                             Diagnostics& found);

extern template std::vector<double> add_soil<2>(Scene<2>&, const Model&, Filling, Diagnostics&);
extern template std::vector<double> add_soil<3>(Scene<3>&, const Model&, Filling, Diagnostics&);

}  // namespace sphgeo
