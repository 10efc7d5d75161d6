#include <fmt/format.h>

#include <iostream>
#include <optional>

#include "cli/commands.h"
#include "cli/stop_requests.h"
#include "core/error.h"
#include "core/text.h"
#include "output/progress.h"
#include "report/page.h"
#include "run/run_deck.h"

namespace sphgeo {
namespace {

/// Tells on stderr how a run goes, and takes the reasons to end it early.
class Terminal final : public RunObserver {
 public:
  explicit Terminal(const RunOptions& options)
      : options_(options), progress_(std::cerr, progress_style_of_stderr(options.quiet)) {}
  ~Terminal() override { progress_.clear(); }

  void findings(const Diagnostics& found) override { std::cerr << found.render(); }
  void warning(const std::string& text) override {
    std::cerr << "warning: " << printable(text) << "\n";
  }
  void note(const std::string& text) override {
    if (!options_.quiet) std::cerr << printable(text) << "\n";
  }
  void begins(const RunFolder& folder) override {
    requests_.emplace(folder.stop_file(), options_.limits);
  }
  void resumes(double time, Index steps, const std::string& checkpoint) override {
    std::cerr << fmt::format("continuing from t = {:.6g} s, advection step {} ({})\n", time, steps,
                             printable(checkpoint));
  }
  void progress(const ProgressState& state) override { progress_.update(state); }
  std::string stop_reason(const RunPosition& at) override {
    return requests_->reason(at.wall_seconds, at.reserve_seconds, at.advection_steps,
                             at.acoustic_steps);
  }
  /// Removes the bar before other text is printed.
  void clear() { progress_.clear(); }

 private:
  const RunOptions& options_;
  Progress progress_;
  std::optional<StopRequests> requests_;
};

void print_costs(const Summary& summary) {
  std::cerr << render_time_table(summary.effects);
  std::cerr << fmt::format(
      "{} acoustic steps, {:.3g} million particle updates per second and core on {} thread{}\n",
      summary.acoustic_steps, summary.particle_updates_per_s_per_core / 1e6, summary.threads,
      summary.threads == 1 ? "" : "s");
  if (summary.checkpoint.count > 0)
    std::cerr << fmt::format(
        "{} checkpoint{}, {:.3g} MB, {:.3g} s each\n", summary.checkpoint.count,
        summary.checkpoint.count == 1 ? "" : "s",
        static_cast<double>(summary.checkpoint.bytes) / 1e6,
        summary.checkpoint.seconds / static_cast<double>(summary.checkpoint.count));
}

/// Compression by the pressure of a stagnation point, Ma^2 / 2, is 5 % there.
constexpr double most_mach = 0.3;

void print_end(const RunResult& run) {
  const Summary& summary = run.summary;
  for (const auto& [name, count] : run.lost)
    std::cerr << fmt::format("warning: {} particles of '{}' left the domain and were removed\n",
                             count, name);
  if (const double mach = summary.guard.extreme("max_mach_water"); mach > most_mach)
    std::cerr << fmt::format(
        "warning: water moved at {:.2g} times its speed of sound at t = {:.4g} s; above {:g} its "
        "density changes by more than 5 %, and pressures are not those of a liquid: give it a "
        "larger max_speed or sound_speed\n",
        mach, summary.guard.extreme("max_mach_water_time"), most_mach);
  if (!summary.expect.empty() && summary.status != "stopped")
    std::cout << render_expectations(summary.expect);
  if (summary.status == "stopped")
    std::cerr << fmt::format(
        "stopped at t = {:.6g} s: {}; the same command with --resume continues the run\n",
        summary.time_s, summary.message);
  else if (!summary.message.empty())
    std::cerr << "error: " << printable(summary.message, "\n") << "\n"
              << (summary.checkpoint.count > 0 ? "the last checkpoint is intact: " +
                                                     printable(run.folder.checkpoint()) + "\n"
                                               : "");
}

/// Writes the page, and returns the exit code. The page is written last: if it fails, the results
/// are complete and the page can be made from them.
int write_page(const RunResult& run) {
  const int code = run.summary.exit_code;
  const std::string& folder = run.folder.path();
  try {
    write_report({folder}, run.folder.report());
  } catch (const std::exception& e) {
    std::cerr << "warning: there is no report.html: " << printable(e.what()) << "; 'sphgeo report "
              << printable(folder) << "' writes it again\n";
    if (code == 0 && dynamic_cast<const IoError*>(&e)) return static_cast<int>(ExitCode::io);
  }
  return code;
}

}  // namespace

int run_command(const RunOptions& options) {
  RunSettings settings;  // its clock starts before the deck is read
  settings.deck = options.deck;
  settings.folder = options.folder;
  settings.existing = options.resume      ? ExistingResults::resume
                      : options.overwrite ? ExistingResults::overwrite
                                          : ExistingResults::refuse;
  settings.threads = options.threads;
  settings.verify = options.verify;
  const Model model = read_deck(options.deck, options.set);
  Terminal terminal(options);
  const RunResult run = run_deck(model, settings, terminal);
  terminal.clear();
  if (!options.quiet) print_costs(run.summary);
  print_end(run);
  return options.report ? write_page(run) : run.summary.exit_code;
}

}  // namespace sphgeo
