#include "run/run_deck.h"

#include <algorithm>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "run/forecast.h"
#include "run/keeper.h"
#include "run/recorder.h"
#include "run/relaxation_report.h"
#include "run/run_summary.h"
#include "run/thread_count.h"
#include "run/wishes.h"
#include "scene/build.h"
#include "scene/cross_check.h"
#include "solve/stepper.h"

namespace sphgeo {
namespace {

/// What a resumed run finds in its folder: a checkpoint, or nothing to continue from.
FoundCheckpoint checkpoint_of(const Model& model, const RunSettings& settings,
                              RunObserver& observer) {
  const std::string& folder = settings.folder;
  if (settings.existing != ExistingResults::resume || !holds_results(folder)) return {};
  FoundCheckpoint found =
      find_checkpoint(folder + "/checkpoint.h5", folder + "/checkpoint.prev.h5");
  for (const std::string& warning : found.warnings) observer.warning(warning);
  if (!found.reader) {
    observer.warning(folder + " holds no checkpoint yet: the run starts at t = 0");
    return {};
  }
  require_same_deck(model, *found.reader);
  return found;
}

/// The run of one deck in one dimension.
template <int Dim>
class DeckRun {
 public:
  DeckRun(const Model& model, const RunSettings& settings, RunObserver& observer)
      : model_(model), settings_(settings), observer_(observer) {}

  RunResult operator()() {
    auto lock = std::make_unique<FolderLock>(settings_.folder);
    FoundCheckpoint checkpoint = checkpoint_of(model_, settings_, observer_);
    const StateSource* resumed = checkpoint.reader.get();
    const std::uint64_t base = resident_memory();
    Scene<Dim> scene = make_scene(resumed);
    World<Dim>& world = *scene.world;
    // Without a checkpoint, the contents of the folder cannot be used by a resumed run.
    const RunFolder folder(settings_.folder,
                           settings_.existing == ExistingResults::resume && !resumed
                               ? ExistingResults::overwrite
                               : settings_.existing);
    observer_.begins(folder);
    const std::vector<Wish> wishes = wishes_of(model_, world);
    Plan<Dim> plan(world, wishes);
    if (resumed) {
      world.load(*resumed);
      plan.load(*resumed);
    }
    Stepper<Dim> stepper(world, plan);
    Spent before;
    if (resumed) {
      stepper.load(*resumed);
      before = spent_of(*resumed, "spent");
      observer_.resumes(world.clock.time, world.clock.advection_steps, checkpoint.path);
    }
    write_file_atomically(folder.resolved_deck(), resolved_yaml(model_));
    const BoundaryMesh walls = boundary_mesh(model_);
    Recorder<Dim> recorder(model_, world, plan, walls, folder, resumed);
    checkpoint.reader.reset();  // its memory is needed for the neighbor lists
    set_threads(sensible_threads(moving_particles(world), settings_.threads));
    const RunParts<Dim> parts{model_, world, plan, stepper, recorder};
    Keeper<Dim> keeper(parts, folder, before, processor_start_);
    RunForecast<Dim> forecast(model_, world, plan, stepper, scene.sound, wishes, walls, base,
                              settings_.threads, std::move(starting_));

    const std::optional<UnstableError> failure = step(parts, keeper, forecast);
    recorder.flush();
    RunResult result{std::move(lock), folder, {}, {}};
    Summary& summary = result.summary;
    summary.forecast = forecast.result();
    summary.wall_s = before.seconds + wall();
    summarize(model_, parts, keeper, settings_.verify, {failure, stopped_}, summary);
    summary.deck = settings_.deck;
    summary.disk_bytes = folder_bytes(settings_.folder);
    write_summary(folder.summary(), summary);
    for (const auto& [set, count] : world.lost())
      if (count > 0) result.lost.emplace_back(set, count);
    return result;
  }

 private:
  /// Wall time so far, s.
  double wall() const { return seconds_since(settings_.start); }

  Scene<Dim> make_scene(const StateSource* resumed) {
    Diagnostics found = model_.warnings;
    Scene<Dim> scene =
        build_scene<Dim>(model_, found, resumed ? Filling::none : Filling::bodies_and_boundaries);
    if (!resumed) check_scene(scene, found);
    if (found.has_errors()) throw DeckError(found);
    if (!found.items().empty()) observer_.findings(found);
    if (scene.pore_water) observer_.note(relaxation_line(model_, *scene.pore_water));
    return scene;
  }

  /// Advances to the end time, or until the guard or the observer stops the run.
  std::optional<UnstableError> step(const RunParts<Dim>& parts, Keeper<Dim>& keeper,
                                    RunForecast<Dim>& forecast) {
    World<Dim>& world = parts.world;
    const Index particles = moving_particles(world);
    const Index steps_before = world.clock.advection_steps,
                acoustic_before = world.clock.acoustic_steps;
    const double wall_before = keeper.wall_before();
    RunHooks hooks;
    hooks.at_safe_point = [&] {
      forecast.arrive();
      parts.recorder.observe(wall_before + wall(), world.clock.time >= model_.end_time);
      const Clock& c = world.clock;
      observer_.progress({c.time, model_.end_time, c.advection_steps, c.acoustic_steps,
                          c.dt_acoustic, particles, wall()});
      forecast.leave(parts.recorder.time_rows());
      return true;
    };
    double asked_at = wall(), longest_wait = 0;  // s
    const auto ask = [&](double now, std::optional<long> steps) {
      longest_wait = std::max(longest_wait, now - std::exchange(asked_at, now));
      // Time to stop: one more step, and the checkpoint (of unknown duration: assumed to be slow).
      const double reserve =
          longest_wait + (keeper.count() > 0 ? keeper.last_seconds()
                                             : 1e-7 * static_cast<double>(world.bytes()) / 100);
      stopped_ = observer_.stop_reason(
          {now, reserve, steps, world.clock.acoustic_steps - acoustic_before});
      return !stopped_.empty();
    };
    hooks.before_acoustic_step = [&] {
      const double now = wall();
      if (!ask(now, {})) return true;
      keeper.keep(now);
      return false;
    };
    hooks.before_rearranging = [&] {
      const double now = wall();
      if (ask(now, world.clock.advection_steps - steps_before) ||
          world.clock.time >= model_.end_time)
        keeper.keep(now);
      else keeper.keep_if_due(now);
      return stopped_.empty();
    };
    try {
      parts.stepper.run(model_.end_time, hooks);
    } catch (const UnstableError& e) {
      parts.recorder.write_frame();
      return e;
    }
    return std::nullopt;
  }

  const Model& model_;
  const RunSettings& settings_;
  double processor_start_ = processor_seconds();  // of the process, s
  std::unique_ptr<QuietWatch> starting_ = std::make_unique<QuietWatch>();
  RunObserver& observer_;
  std::string stopped_;  ///< why the run ends early
};

}  // namespace

RunResult run_deck(const Model& model, const RunSettings& settings, RunObserver& observer) {
  refuse_too_large(model);
  if (settings.threads > 0) set_threads(settings.threads);  // also while the scene is built
  if (model.dimension == 2) return DeckRun<2>(model, settings, observer)();
  return DeckRun<3>(model, settings, observer)();
}

}  // namespace sphgeo
