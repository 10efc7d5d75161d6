#pragma once
// Whether a scene is small enough for its spacing.

#include "core/diagnostic.h"
#include "deck/model.h"

namespace sphgeo {

/// Reports (E146) bodies and boundaries that lie so far apart that positions, kept in 2^32 steps
/// across the domain, would be coarse beside the spacing: more than a million spacings. A domain
/// that the deck gives limits what counts.
void check_extent(const Model& model, Diagnostics& found);

}  // namespace sphgeo
