#pragma once
// Whether what a deck wants of a run can be written and measured.

#include "core/diagnostic.h"
#include "deck/model.h"

namespace sphgeo {

/// Reports columns of claims that their probe does not have (E150), reference curves that cannot be
/// compared with their column (E151), claims of profiles of other probes (E155), and fields of
/// frames that do not exist (E152): before a run and not after it.
void check_outputs(const Model& model, Diagnostics& found);

}  // namespace sphgeo
