#pragma once
// The table that a curve of a deck's claims is compared with.

#include <optional>
#include <string_view>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// Points of a reference as they are compared: time, s, and values in the unit of the probe.
struct ReferenceCurve {
  std::vector<double> x, y;  ///< NaN where the table has no value
};

/// Reads the reference_csv of a claim. Units in the headings are converted, to seconds (of a
/// profile, to metres) and to `unit` of the probe's column where it is known. Where the deck scales
/// a column itself (x_scale, y_scale, scale), plain numbers get their meaning from it; a unit that
/// says something else than the factor is an error. Throws IoError, or TableError with file and
/// line for a table that cannot be used, has no point between `from` and `to`, or only one value
/// where the norm is by the range.
ReferenceCurve read_reference(const Expect& claim, std::optional<std::string_view> unit);

}  // namespace sphgeo
