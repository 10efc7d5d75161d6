#pragma once
// From the model to the table of parameters that the running scene reads.

#include <vector>

#include "deck/model.h"
#include "sph/parameters.h"

namespace sphgeo {

/// All parameters that follow from the model alone: not the speed of sound of the water, and
/// nothing of the soil. Pointers in it lead into the model.
Parameters compile_parameters(const Model& model);

/// Parameters of the soil with the densities at rest of its bodies [kg/m3], one for each body of
/// the deck; those of other bodies are not looked at.
SoilParameters compile_soil(const Model& model, const std::vector<double>& densities);

}  // namespace sphgeo
