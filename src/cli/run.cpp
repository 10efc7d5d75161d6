#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <optional>

#include "cli/commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "core/version.h"
#include "output/progress.h"
#include "report/page.h"
#include "run/forecast.h"
#include "run/keeper.h"
#include "run/recorder.h"
#include "run/relaxation_report.h"
#include "run/thread_count.h"
#include "run/wishes.h"
#include "scene/build.h"
#include "scene/cross_check.h"
#include "solve/stepper.h"

namespace sphgeo {
namespace {

using clock_type = std::chrono::steady_clock;

ProgressState progress_of(const Model& model, const Clock& c, Index particles, double wall) {
  return {c.time, model.end_time, c.advection_steps, c.acoustic_steps, c.dt_acoustic, particles,
          wall};
}

/// What --resume finds in the folder: a checkpoint, or nothing to continue from.
FoundCheckpoint checkpoint_of(const RunOptions& options, const Model& model) {
  if (!options.resume || !holds_results(options.folder)) return {};
  const std::string folder = options.folder;
  FoundCheckpoint found =
      find_checkpoint(folder + "/checkpoint.h5", folder + "/checkpoint.prev.h5");
  for (const std::string& warning : found.warnings)
    std::cerr << "warning: " << printable(warning) << "\n";
  if (!found.reader) {
    std::cerr << "warning: " << printable(folder)
              << " holds no checkpoint yet: the run starts at t = 0\n";
    return {};
  }
  require_same_deck(model, *found.reader);
  return found;
}

/// The run of one deck in one dimension.
template <int Dim>
class DeckRun {
 public:
  DeckRun(const Model& model, const RunOptions& options, clock_type::time_point start)
      : model_(model),
        options_(options),
        start_(start),
        progress_(std::cerr, progress_style_of_stderr(options.quiet)) {}

  int operator()() {
    const FolderLock lock(options_.folder);
    FoundCheckpoint checkpoint = checkpoint_of(options_, model_);
    const StateSource* resumed = checkpoint.reader.get();
    const std::uint64_t base = resident_memory();
    Scene<Dim> scene = make_scene(resumed);
    World<Dim>& world = *scene.world;
    std::vector<std::string> names;
    for (const auto& set : world.sets()) names.push_back(set->name());

    // Without a checkpoint, the contents of the folder cannot be used by a resumed run.
    const RunFolder folder(options_.folder, resumed ? ExistingResults::resume
                                            : options_.overwrite || options_.resume
                                                ? ExistingResults::overwrite
                                                : ExistingResults::refuse);
    StopRequests requests(folder.stop_file(), options_.limits);
    const std::vector<Wish> wishes = wishes_of(model_, names);
    Plan<Dim> plan(world, wishes);
    if (resumed) {
      world.load(*resumed);
      plan.load(*resumed);
    }
    Stepper<Dim> stepper(world, plan);
    if (resumed) {
      stepper.load(*resumed);
      wall_before_ = resumed->number("wall_seconds");
      steps_before_ = world.clock.advection_steps;
      acoustic_before_ = world.clock.acoustic_steps;
      std::cerr << fmt::format("continuing from t = {:.6g} s, advection step {} ({})\n",
                               world.clock.time, steps_before_, printable(checkpoint.path));
    }
    write_file_atomically(folder.resolved_deck(), resolved_yaml(model_));
    Recorder<Dim> recorder(world, plan, folder, resumed);
    checkpoint.reader.reset();  // its memory is needed for the neighbor lists
    Index particles = 0;
    for (const auto& set : world.sets())
      if (set->phase() != "wall") particles += set->size();
    set_threads(sensible_threads(particles, options_.threads));
    Keeper<Dim> keeper({world, plan, stepper, recorder}, folder, wall_before_);

    RunForecast<Dim> forecast(world, plan, stepper, scene.sound, wishes, base);
    RunHooks hooks;
    hooks.at_safe_point = [&] {
      forecast.arrive(seconds_since(start_));
      recorder.observe(wall_before_ + seconds_since(start_), world.clock.time >= model_.end_time);
      progress_.update(progress_of(model_, world.clock, particles, seconds_since(start_)));
      forecast.leave(recorder.time_rows());
      return true;
    };
    double asked_at = seconds_since(start_), longest_wait = 0;  // s
    const auto ask = [&](double wall, std::optional<long> steps) {
      longest_wait = std::max(longest_wait, wall - std::exchange(asked_at, wall));
      // Time to stop: one more step, and the checkpoint (of unknown duration: assumed to be slow).
      const double reserve =
          longest_wait + (keeper.count() > 0 ? keeper.last_seconds()
                                             : 1e-7 * static_cast<double>(world.bytes()) / 100);
      stopped_ =
          requests.reason(wall, reserve, steps, world.clock.acoustic_steps - acoustic_before_);
      return !stopped_.empty();
    };
    hooks.before_acoustic_step = [&] {
      const double wall = seconds_since(start_);
      if (!ask(wall, {})) return true;
      keeper.keep(wall);
      return false;
    };
    hooks.before_rearranging = [&] {
      const double wall = seconds_since(start_);
      if (ask(wall, world.clock.advection_steps - steps_before_) ||
          world.clock.time >= model_.end_time)
        keeper.keep(wall);
      else keeper.keep_if_due(wall);
      return stopped_.empty();
    };
    std::optional<UnstableError> failure;
    try {
      stepper.run(model_.end_time, hooks);
    } catch (const UnstableError& e) {
      failure = e;
      recorder.write_frame();
    }
    progress_.clear();
    summary_.forecast = forecast.result();
    finish({world, plan, stepper, recorder}, keeper, folder, failure);
    return summary_.exit_code;
  }

 private:
  Scene<Dim> make_scene(const StateSource* resumed) {
    Diagnostics found = model_.warnings;
    Scene<Dim> scene =
        build_scene<Dim>(model_, found, resumed ? Filling::none : Filling::bodies_and_boundaries);
    if (!resumed) check_scene(scene, found);
    if (found.has_errors()) throw DeckError(found);
    if (!found.items().empty()) std::cerr << found.render();
    if (scene.pore_water && !options_.quiet)
      std::cerr << printable(relaxation_line(model_, *scene.pore_water)) << "\n";
    return scene;
  }

  void finish(const RunParts<Dim>& parts, const Keeper<Dim>& keeper, const RunFolder& folder,
              const std::optional<UnstableError>& failure) {
    const World<Dim>& world = parts.world;
    parts.recorder.flush();
    summary_.expect = evaluate(relaxation_expects(model_, false), [&](const std::string& name) {
      return parts.recorder.series(name);
    });
    bool met = true;
    for (const ExpectResult& r : summary_.expect) met = met && r.pass;
    const bool stopped = !failure && !stopped_.empty();
    summary_.status = failure ? "unstable" : stopped ? "stopped" : "done";
    summary_.message = failure ? failure->what() : stopped_;
    summary_.exit_code = static_cast<int>(failure                   ? ExitCode::unstable
                                          : stopped                 ? ExitCode::stopped
                                          : options_.verify && !met ? ExitCode::mismatch
                                                                    : ExitCode::done);
    summary_.version = version();
    summary_.title = model_.title;
    summary_.deck = options_.deck;
    summary_.deck_hash = deck_hash(model_);
    summary_.dimension = Dim;
    // As they are now: the settings at the start are not known to a resumed run.
    for (const auto& set : world.sets()) summary_.particles.emplace_back(set->name(), set->size());
    summary_.threads = threads();
    summary_.advection_steps = world.clock.advection_steps;
    summary_.acoustic_steps = world.clock.acoustic_steps;
    summary_.solid_steps = world.clock.solid_steps;
    summary_.time_s = world.clock.time;
    summary_.wall_s = wall_before_ + seconds_since(start_);
    summary_.memory_peak_bytes = peak_memory_bytes();
    const Stepper<Dim>& stepper = parts.stepper;
    std::vector<TimeRow> rows = parts.recorder.time_rows();
    double stepping = stepper.seconds_rearranging();
    rows.push_back({"neighbor_lists", stepper.rearrangements(), stepping, 0});
    rows.push_back({"guard", stepper.guard().calls(), stepper.guard().seconds(), 0});
    rows.push_back({"checkpoints", keeper.count(), keeper.seconds(), 0});
    for (const auto& e : parts.plan.effects()) {
      rows.push_back(
          {e.label, e.calls, e.seconds, 0, e.walked_set, e.in_set > 0 ? e.walked / e.in_set : 0});
      summary_.plan.push_back({stage_name(e.info.stage), e.info.name, e.info.equations,
                               e.effect->acts_on(), e.because});
      if (e.info.stage != Stage::observe) stepping += e.seconds;
    }
    summary_.particle_updates_per_s_per_core =
        stepping > 0 ? stepper.particle_updates() / stepping / threads() : 0;
    summary_.effects = with_rest(std::move(rows), summary_.wall_s);
    summary_.ledger = parts.recorder.ledger();
    summary_.checkpoint = {keeper.count(), keeper.seconds(), keeper.bytes()};
    summary_.guard.extremes = stepper.guard().extremes();
    if (failure) {
      const Instability& where = failure->instability;
      summary_.guard.tripped = true;
      summary_.guard.reason = failure->what();
      summary_.guard.cause = where.cause;
      summary_.guard.effect = where.effect;
      summary_.guard.set = where.set;
      summary_.guard.particle = where.particle;
      summary_.guard.place = where.place;
      summary_.guard.time = where.time;
    }
    summary_.disk_bytes = folder_bytes(options_.folder);
    write_summary(folder.summary(), summary_);
    report(world, folder);
    if (options_.report) write_page(folder);
  }

  /// The page is written last: if it fails, the results are complete and the page can be made from
  /// them.
  void write_page(const RunFolder& folder) {
    try {
      write_report({options_.folder}, folder.report());
    } catch (const std::exception& e) {
      std::cerr << "warning: there is no report.html: " << printable(e.what())
                << "; 'sphgeo report " << printable(options_.folder) << "' writes it again\n";
      if (summary_.exit_code == 0 && dynamic_cast<const IoError*>(&e))
        summary_.exit_code = static_cast<int>(ExitCode::io);
    }
  }

  void report(const World<Dim>& world, const RunFolder& folder) const {
    if (!options_.quiet) {
      std::cerr << render_time_table(summary_.effects);
      std::cerr << fmt::format(
          "{} acoustic steps, {:.3g} million particle updates per second and core on {} thread{}\n",
          summary_.acoustic_steps, summary_.particle_updates_per_s_per_core / 1e6, summary_.threads,
          summary_.threads == 1 ? "" : "s");
      if (summary_.checkpoint.count > 0)
        std::cerr << fmt::format(
            "{} checkpoint{}, {:.3g} MB, {:.3g} s each\n", summary_.checkpoint.count,
            summary_.checkpoint.count == 1 ? "" : "s",
            static_cast<double>(summary_.checkpoint.bytes) / 1e6,
            summary_.checkpoint.seconds / static_cast<double>(summary_.checkpoint.count));
    }
    for (const auto& [name, count] : world.lost())
      if (count > 0)
        std::cerr << fmt::format("warning: {} particles of '{}' left the domain and were removed\n",
                                 count, name);
    if (!summary_.expect.empty() && summary_.status != "stopped")
      std::cout << render_expectations(summary_.expect);
    if (summary_.status == "stopped")
      std::cerr << fmt::format(
          "stopped at t = {:.6g} s: {}; the same command with --resume continues the run\n",
          summary_.time_s, summary_.message);
    else if (!summary_.message.empty())
      std::cerr << "error: " << printable(summary_.message, "\n") << "\n"
                << (summary_.checkpoint.count > 0
                        ? "the last checkpoint is intact: " + printable(folder.checkpoint()) + "\n"
                        : "");
  }

  const Model& model_;
  const RunOptions& options_;
  clock_type::time_point start_;
  Progress progress_;
  Summary summary_;
  double wall_before_ = 0;     ///< of the parts of this run that came before, s
  Index steps_before_ = 0;     ///< advection steps of those
  Index acoustic_before_ = 0;  ///< acoustic steps of those
  std::string stopped_;        ///< why the run ends early
};

}  // namespace

int run_command(const RunOptions& options) {
  const auto start = clock_type::now();
  const Model model = read_deck(options.deck, options.set);
  refuse_too_large(model);
  if (options.threads > 0) set_threads(options.threads);  // also while the scene is built
  if (model.dimension == 2) return DeckRun<2>(model, options, start)();
  return DeckRun<3>(model, options, start)();
}

}  // namespace sphgeo
