#pragma once
// Reasons to end a run before its time: a signal, a `stop` file, a limit of wall time or of steps.

#include <optional>
#include <string>

namespace sphgeo {

/// Limits that the command line sets to one run.
struct RunLimits {
  std::optional<double> max_hours;         ///< wall time of this process
  std::optional<long> max_steps;           ///< advection steps of this process
  std::optional<long> max_acoustic_steps;  ///< the same, acoustic
};

/// Asked before every acoustic step. SIGINT, SIGTERM and SIGHUP (unless it is ignored) ask a run to
/// finish that, keep a checkpoint and end; the third signal ends the process at once.
class StopRequests {
 public:
  /// From now on signals are taken. A stop file that is there already is deleted: it belonged to an
  /// earlier run.
  StopRequests(std::string stop_file, RunLimits limits);
  ~StopRequests();
  StopRequests(const StopRequests&) = delete;
  StopRequests& operator=(const StopRequests&) = delete;

  /// Why to stop now, or "". `wall_seconds` of this process so far, `reserve_seconds` what ending
  /// takes, `steps` and `acoustic_steps` of this process; --max-steps holds between two advection
  /// steps. A stop file is deleted when it is obeyed.
  std::string reason(double wall_seconds, double reserve_seconds, std::optional<long> steps,
                     long acoustic_steps);

 private:
  std::string stop_file_;
  RunLimits limits_;
};

}  // namespace sphgeo
