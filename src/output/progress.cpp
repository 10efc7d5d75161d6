#include "output/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <string_view>

namespace sphgeo {

namespace {

constexpr double draw_interval = 0.2;  // s
constexpr double line_interval = 60;   // s, when nothing is reported and there is no bar
constexpr double rate_interval = 0.5;  // s between measurements of the rate
constexpr double rate_memory = 20;     // s over which the rate is averaged
constexpr int bar_width = 30;

double fraction(const ProgressState& s) {
  return s.end_time > 0 ? std::clamp(s.time / s.end_time, 0.0, 1.0) : 0.0;
}

}  // namespace

ProgressStyle progress_style_of_stderr(bool quiet) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool terminal =
      isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
  return {terminal, terminal && (no_color == nullptr || *no_color == '\0'), quiet};
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds > 1e10) return "unknown";
  const auto s = static_cast<std::int64_t>(std::llround(std::max(seconds, 0.0)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  return fmt::format("{} d {} h", s / 86400, s / 3600 % 24);
}

void Progress::measure_rate(const ProgressState& state) {
  if (!rate_since_) {
    rate_since_ = state;
    return;
  }
  const double wall = state.wall_s - rate_since_->wall_s;
  if (wall < rate_interval) return;
  const double now = (state.time - rate_since_->time) / wall;
  const double weight = rate_ > 0 ? 1 - std::exp(-wall / rate_memory) : 1;
  rate_ += weight * (now - rate_);
  rate_since_ = state;
}

std::string Progress::remaining(const ProgressState& state) const {
  if (state.time >= state.end_time) return "done";
  return rate_ > 0 ? duration_text((state.end_time - state.time) / rate_) + " left" : "";
}

void Progress::update(const ProgressState& state) {
  measure_rate(state);
  if (style_.quiet) return;
  if (!style_.terminal) {
    if (state.wall_s - last_line_ >= line_interval) report(state);
    return;
  }
  if (last_draw_ >= 0 && state.wall_s - last_draw_ < draw_interval) return;
  last_draw_ = state.wall_s;
  const int full = static_cast<int>(std::lround(fraction(state) * bar_width));
  const std::string bar = fmt::format("[{}{}]", std::string(static_cast<std::size_t>(full), '='),
                                      std::string(static_cast<std::size_t>(bar_width - full), ' '));
  // Carriage return, text, erase to the end of the line.
  out_ << fmt::format("\r{}{}{} {:5.1f} %  t = {:.4g} s  {} steps  {}\x1b[K",
                      style_.color ? "\x1b[32m" : "", bar, style_.color ? "\x1b[0m" : "",
                      100 * fraction(state), state.time, state.acoustic_steps, remaining(state))
       << std::flush;
  bar_shown_ = true;
}

void Progress::report(const ProgressState& state, const std::string& what) {
  measure_rate(state);
  last_line_ = state.wall_s;
  if (style_.quiet) return;
  clear();
  std::string line = fmt::format("t = {:.4f} s of {:.6g} s ({:.0f} %)  steps {}/{}  dt {:.3g} s",
                                 state.time, state.end_time, 100 * fraction(state),
                                 state.advection_steps, state.acoustic_steps, state.dt);
  if (state.wall_s > 0)
    line += fmt::format("  {:.3g} M updates/s", 1e-6 * static_cast<double>(state.particles) *
                                                    static_cast<double>(state.acoustic_steps) /
                                                    state.wall_s);
  if (const std::string left = remaining(state); !left.empty()) line += "  " + left;
  if (!what.empty()) line += "  " + what;
  out_ << line << '\n' << std::flush;
}

void Progress::clear() {
  if (bar_shown_) out_ << "\r\x1b[K" << std::flush;
  bar_shown_ = false;
}

}  // namespace sphgeo
