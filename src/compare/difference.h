#pragma once
// The differences between a run and its baseline.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/run_data.h"
#include "compare/tolerances.h"

namespace sphgeo {

/// One thing that was compared.
struct RunDifference {
  std::string
      kind;  ///< status, particles, steps, probe, positions, field, ledger, result, missing, new
  std::string name;  ///< "gauge.level"
  double difference =
      0;  ///< as the tolerance of its kind means it; infinite when it cannot be compared
  double tolerance = 0;
  bool pass = false;
  std::string note;  ///< values, or why it could not be compared

  std::string whole_name() const { return name.empty() ? kind : kind + " " + name; }
};

/// All that the baseline holds, compared. A component of a vector, or a column of a probe, whose
/// range is below a hundredth of that of its companions (the other components; the columns of the
/// same unit) is measured by that hundredth: it is noise about zero. The list has the worst first,
/// by difference over tolerance. What only the run has is reported (kind `new`) and passes.
std::vector<RunDifference> compare_runs(const RunData& run, const RunData& baseline,
                                        const Tolerances& tolerances);

/// Difference of a curve from that of the baseline, at the baseline's times.
struct CurveDistance {
  double rms = 0;          ///< root mean square, in the curve's unit
  double range = 0;        ///< of the baseline's curve
  double unsupported = 0;  ///< share of times where only one of them has a value
};
CurveDistance curve_distance(const ProbeCurve& run, const ProbeCurve& baseline);

/// For each position the index of the nearest of `among` (not empty).
std::vector<std::size_t> nearest_positions(const std::vector<Vec3>& positions,
                                           const std::vector<Vec3>& among);

/// As a table, the worst first: all that fail and, of the others, the `shown` nearest to failing.
std::string render_differences(const std::vector<RunDifference>& differences, std::size_t shown);
nlohmann::ordered_json to_json(const std::vector<RunDifference>& differences);

}  // namespace sphgeo
