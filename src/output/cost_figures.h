#pragma once
// Forecast and actual cost of a run: as text, and as JSON for `check --json` and summary.json.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// The cost of a run.
struct RunFigures {
  std::vector<std::pair<std::string, Index>> particles;  ///< by set, at the start
  std::uint64_t memory_bytes = 0;                        ///< at the peak, of the whole process
  std::uint64_t disk_bytes = 0;                          ///< of the run folder at the end
  Index advection_steps = 0, acoustic_steps = 0;
  std::optional<double> wall_s;  ///< none without a calibration
  Index entering = 0;            ///< particles that inlets insert until the end

  Index total_particles() const;
};

/// The same scene at another spacing.
struct LadderRung {
  double resolution;  ///< spacing, m
  RunFigures figures;
  int threads = 1;
  bool fits = true;  ///< into the memory that is available
};

/// Times are those of a machine with nothing else to do.
struct Forecast : RunFigures {
  int threads = 1;
  double slowdown = 1;             ///< by what else the machine did when it was made
  std::vector<LadderRung> ladder;  ///< coarsest first; without the deck's own spacing
};

nlohmann::ordered_json to_json(const RunFigures& figures);
/// With `threads` and `ladder`.
nlohmann::ordered_json to_json(const Forecast& forecast);

/// The forecast and its ladder as lines of text for a deck of this spacing (m).
std::string render_forecast(const Forecast& forecast, double resolution);

/// Bytes of all files below a folder; 0 when it cannot be read.
std::uint64_t folder_bytes(const std::string& folder);

/// "640 kB", "12.5 MB", "1.20 GB", "3.4 TB".
std::string bytes_text(double bytes);

}  // namespace sphgeo
