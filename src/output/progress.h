#pragma once
// Progress of a run on stderr.

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

namespace sphgeo {

/// State of a run.
struct ProgressState {
  double time = 0;      ///< simulated, s
  double end_time = 0;  ///< s
  std::int64_t advection_steps = 0;
  std::int64_t acoustic_steps = 0;
  double dt = 0;  ///< last acoustic step, s
  std::int64_t particles = 0;
  double wall_s = 0;  ///< since the run began
};

struct ProgressStyle {
  bool terminal = false;  ///< may draw a bar that rewrites its line
  bool color = false;
  bool quiet = false;
};

/// The style that fits stderr: a bar only on a terminal that is not dumb, no color with NO_COLOR
/// set.
ProgressStyle progress_style_of_stderr(bool quiet = false);

/// One line for each report; between them, on a terminal, a bar. Elsewhere a line a minute when
/// nothing is reported.
class Progress {
 public:
  Progress(std::ostream& out, ProgressStyle style) : out_(out), style_(style) {}

  /// May be called in every step: draws at most a few times a second.
  void update(const ProgressState& state);
  /// Prints a line; `what` is added at its end ("frame 12").
  void report(const ProgressState& state, const std::string& what = {});
  /// Removes the bar before other text is printed.
  void clear();

 private:
  void measure_rate(const ProgressState& state);
  std::string remaining(const ProgressState& state) const;

  std::ostream& out_;
  ProgressStyle style_;
  std::optional<ProgressState> rate_since_;
  double rate_ = 0;  ///< simulated seconds per second of wall time, moving
  double last_draw_ = -1;
  double last_line_ = 0;
  bool bar_shown_ = false;
};

/// "45 s", "3 min 20 s", "2 h 05 min", "3 d 4 h".
std::string duration_text(double seconds);

}  // namespace sphgeo
