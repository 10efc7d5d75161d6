#pragma once
// Computing time of a run: one row per effect, and a row for the rest.

#include <cstdint>
#include <string>
#include <vector>

#include "core/stopwatch.h"

namespace sphgeo {

/// One row: an effect (or "rest"), how often it ran and what that took.
struct TimeRow {
  std::string name;
  std::int64_t calls = 0;
  Spent spent = {};
  std::string walked_set = {};  ///< the set of which it loops only over the particles near another
                                ///< set; empty: no such effect
  double walked_share = 0;      ///< of that set, in 0..1, mean over all calls
  double share = 0;             ///< of the wall time of the run, in 0..1
  double busy = 0;  ///< processor time over wall time and threads: 1 when all threads work
};

/// Sets the shares, sorts by time (ties by name), drops rows that never ran and appends "rest": the
/// time that no row accounts for. `whole` is that of the whole run.
std::vector<TimeRow> with_rest(std::vector<TimeRow> rows, const Spent& whole);

/// The table as text for a terminal, with a line for the total; `rows` come from with_rest().
std::string render_time_table(const std::vector<TimeRow>& rows);

}  // namespace sphgeo
