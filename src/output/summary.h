#pragma once
// summary.json: results of a run, for scripts.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "output/cost_figures.h"
#include "output/expectation.h"
#include "output/time_table.h"

namespace sphgeo {

/// One conserved quantity: kg, kg m/s or J (per metre of depth in 2D); vectors have several
/// components.
struct LedgerRow {
  std::string name;  ///< mass, momentum, energy ...
  std::string unit;
  std::vector<double> initial, final;
  std::vector<double> exchanged;  ///< input by boundaries and gravity; empty = none
  double relative_error = 0;      ///< unexplained change, over a scale of the run
};

/// Quantities watched by the guard, and the reason for a stop.
struct GuardReport {
  bool tripped = false;
  std::string reason, cause, effect, set;  ///< empty unless tripped; cause is one word
  std::optional<Id> particle;
  std::optional<Vec3> place;                             ///< m
  std::optional<double> time;                            ///< s
  std::vector<std::pair<std::string, double>> extremes;  ///< max_speed, min_density, lost ...

  /// One of the extremes; 0 when it was not watched.
  double extreme(const std::string& name) const {
    for (const auto& [key, value] : extremes)
      if (key == name) return value;
    return 0;
  }
};

/// The checkpoints that this process has written.
struct CheckpointReport {
  long count = 0;
  double seconds = 0;       ///< all of them
  std::uint64_t bytes = 0;  ///< the last one
};

/// One step of the plan: an effect, and why it ran.
struct PlanRow {
  std::string stage, name, equations, acts_on, because;
};

/// The contents of summary.json.
struct Summary {
  std::string status;  ///< done, unstable, stopped, failed
  int exit_code = 0;
  std::string message;  ///< one sentence when the run did not end as planned
  std::string version;
  std::string title, deck, deck_hash;
  int dimension = 0;
  int threads = 1;
  std::vector<std::pair<std::string, Index>> particles;
  Index advection_steps = 0, acoustic_steps = 0, solid_steps = 0;
  double time_s = 0;  ///< simulated
  double wall_s = 0;
  double busy = 0;                             ///< processor time over wall time and threads
  double particle_updates_per_s_per_core = 0;  ///< one update = one acoustic step of one particle
  std::uint64_t memory_peak_bytes = 0;
  std::uint64_t disk_bytes = 0;      ///< of the run folder
  std::optional<Forecast> forecast;  ///< made at the start
  std::vector<TimeRow> effects;      ///< from with_rest()
  std::vector<PlanRow> plan;         ///< in the order in which they ran
  std::vector<ExpectResult> expect;
  std::vector<LedgerRow> ledger;
  GuardReport guard;
  CheckpointReport checkpoint;
};

/// The summary as JSON, keys in a fixed order; numbers that are not finite become null.
nlohmann::ordered_json to_json(const Summary& summary);

/// Writes summary.json, whole or not at all. Throws IoError.
void write_summary(const std::string& path, const Summary& summary);

/// The largest memory this process has held so far, bytes; 0 when the system does not tell.
std::uint64_t peak_memory_bytes();

}  // namespace sphgeo
