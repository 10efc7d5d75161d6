#pragma once
// Report of a relaxation of water in soil: its history, one line, and the claims about it.

#include <string>
#include <vector>

#include "deck/model.h"
#include "output/series.h"
#include "scene/pore_water.h"

namespace sphgeo {

/// The history as a probe called `relaxation`, whose time is the number of the step:
/// density_spread, mass_error (particles) and others. One row even when nothing was free to move.
Series relaxation_series(const Model& model, const PoreWater& water);

/// Writes it as CSV. Throws IoError.
void write_relaxation(const std::string& path, const Series& history);

/// "water in soil: 1200 particles, ...": without a line end.
std::string relaxation_line(const Model& model, const PoreWater& water);

/// The claims of a deck about the relaxation, or all the others: `relax` measures those, `run`
/// these.
std::vector<Expect> relaxation_expects(const Model& model, bool about_relaxation);

}  // namespace sphgeo
