#pragma once
// How many particles a deck takes, without filling anything.

#include <string>
#include <utility>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// Numbers of particles by set; expected ones are no whole numbers.
using ParticleCounts = std::vector<std::pair<std::string, double>>;

/// Particles to be expected in each set: volumes of the bodies over dp^Dim, layers of the walls.
/// Good to a few percent, and quick at any resolution. Infinite when a shape has no bounds.
ParticleCounts expected_particles(const Model& model);

/// Particles of water that inlets bring in until the end. What reservoirs add is not known before.
double entering_particles(const Model& model);

/// Of that set, 0 when there is none.
double count_of(const ParticleCounts& counts, const std::string& set);
double total_of(const ParticleCounts& counts);

/// The same deck at another spacing. What formulas of the deck made of `resolution` stays as it
/// was.
Model at_resolution(const Model& model, double spacing);

}  // namespace sphgeo
