#pragma once
// The relaxation of a deck's water in soil as a job of its own, with a folder like that of a run.

#include "run/run_deck.h"
#include "scene/pore_water.h"

namespace sphgeo {

/// The result of a relaxation.
struct RelaxResult {
  PoreWater water;
  Summary summary;  ///< as in summary.json, which also has the measures of the relaxation
};

/// Relaxes the water in the pores of soil, whatever file the deck names, and writes it to the
/// folder as `relaxed.h5`, with its history, frames and a summary. `settings.threads` = 0 leaves
/// the number of threads as it is; the observer is told of findings alone. Throws Error (usage)
/// when there is no such water or the folder is taken, DeckError, IoError.
RelaxResult relax_deck(const Model& model, const RunSettings& settings, RunObserver& observer);

}  // namespace sphgeo
