#pragma once
// Number of particles of a deck, without filling its shapes.

#include <string>
#include <utility>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// Numbers of particles by set; expected ones are not whole numbers.
using ParticleCounts = std::vector<std::pair<std::string, double>>;

/// Expected number of particles in each set: volumes of the bodies over dp^Dim, layers of the
/// walls. Good to a few percent, and quick at any resolution. Infinite when a shape has no bounds.
ParticleCounts expected_particles(const Model& model);

/// Particles of water that inlets insert until the end. The number inserted by reservoirs is not
/// known in advance.
double entering_particles(const Model& model);

/// Of that set, 0 when there is none.
double count_of(const ParticleCounts& counts, const std::string& set);
double total_of(const ParticleCounts& counts);

/// The same deck at another spacing. Values of formulas of `resolution` stay as they were.
Model at_resolution(const Model& model, double spacing);

}  // namespace sphgeo
