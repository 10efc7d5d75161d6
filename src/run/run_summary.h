#pragma once
// The results of a run, for summary.json.

#include <optional>
#include <string>

#include "core/error.h"
#include "run/keeper.h"

namespace sphgeo {

/// How a run ended: by itself when neither is given.
struct RunEnd {
  const std::optional<UnstableError>& failure;
  const std::string& stopped;  ///< why it was ended early; "" when it was not
};

/// Fills in all that the parts of a run know when it is over, from the status to the checkpoints;
/// `summary.wall_s` must be there. With `verify` a missed `expect` is the exit code `mismatch`.
/// Throws IoError and TableError for an unreadable reference table.
template <int Dim>
void summarize(const Model& model, const RunParts<Dim>& parts, const Keeper<Dim>& keeper,
               bool verify, const RunEnd& end, Summary& summary);

}  // namespace sphgeo
