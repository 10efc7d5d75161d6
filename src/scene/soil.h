#pragma once
// Soil particles and their initial state.

#include <vector>

#include "scene/build.h"

namespace sphgeo {

/// The particles of one body before they join their set.
struct BodyPoints {
  std::vector<Vec3> at;
  double volume;  ///< of one particle, m3 (m2 in 2D)
};

/// Fills the shape of a body as its `filling` says.
BodyPoints fill_body(const Body& body, const Model& model);

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
