#pragma once
// Data of a run for comparison: curves of probes, fields at the end, conserved quantities, results.

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// The curve of one column of a probe; NaN where there was no support.
struct ProbeCurve {
  std::string probe, column, unit;
  std::vector<double> t, y;  ///< s, and the column's unit
};

/// A field of one component at the particles of a SetState.
struct FieldState {
  std::string name;  ///< "pressure", "velocity.x"
  std::vector<double> values;
};

/// A set of particles at the end of a run.
struct SetState {
  std::string set;
  Index particles = 0;          ///< of the whole set; positions may be a sample of it
  std::vector<Vec3> positions;  ///< m
  std::vector<FieldState> fields;
};

/// A conserved quantity at the start and the end.
struct LedgerState {
  std::vector<double> initial, final;
};

/// A result under `expect`.
struct ResultState {
  std::optional<double> value;
  double tolerance = 0;
  bool pass = false;
};

/// A run or a baseline.
struct RunData {
  std::string path, title, status, version, date;
  double resolution = 0;                              ///< m
  double time = 0;                                    ///< simulated, s
  std::vector<std::pair<std::string, double>> steps;  ///< advection, acoustic, solid
  std::vector<ProbeCurve> probes;
  std::vector<SetState> sets;
  std::vector<std::pair<std::string, LedgerState>> ledger;
  std::vector<std::pair<std::string, ResultState>> results;
};

/// Reads a run folder: all rows of all probes and the last frame of each set of particles. Throws
/// IoError, TableError; Error (usage) when the folder holds no finished run.
RunData read_run_data(const std::string& folder);

/// Reads a baseline that write_baseline() has written. Throws IoError; Error (usage) with the path
/// when it is damaged or not a baseline.
RunData read_baseline(const std::string& path);

/// How much of a run a baseline keeps.
struct BaselineSize {
  std::size_t rows = 100;       ///< of a probe, evenly chosen, the last among them
  std::size_t particles = 100;  ///< of a set, chosen by a hash of their number
};

/// Writes the run as a baseline: one JSON file, numbers to seven digits. Throws IoError.
void write_baseline(const std::string& path, const RunData& run, const BaselineSize& size = {});

/// A folder is read as a run, anything else as a baseline.
RunData read_either(const std::string& path);

}  // namespace sphgeo
