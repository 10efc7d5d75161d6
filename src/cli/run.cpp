#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <thread>

#include "cli/commands.h"
#include "cli/recorder.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "output/progress.h"
#include "scene/build.h"
#include "scene/cross_check.h"
#include "solve/stepper.h"

namespace sphgeo {
namespace {

using clock_type = std::chrono::steady_clock;

double seconds_since(clock_type::time_point start) {
  return std::chrono::duration<double>(clock_type::now() - start).count();
}

ProgressState progress_of(const Model& model, const Clock& c, Index particles, double wall) {
  return {c.time, model.end_time, c.advection_steps, c.acoustic_steps, c.dt_acoustic, particles, wall};
}

/// The run of one deck in one dimension.
template <int Dim>
class DeckRun {
 public:
  DeckRun(const Model& model, const RunOptions& options, clock_type::time_point start)
      : model_(model), options_(options), start_(start), progress_(std::cerr, progress_style_of_stderr(options.quiet)) {}

  int operator()() {
    Diagnostics found = model_.warnings;
    Scene<Dim> scene = build_scene<Dim>(model_, found);
    check_scene(scene, found);
    if (found.has_errors()) throw DeckError(found);
    if (!found.items().empty()) std::cerr << found.render();
    World<Dim>& world = *scene.world;
    Index particles = 0;
    std::vector<std::string> names;
    for (const auto& set : world.sets()) {
      names.push_back(set->name());
      if (set->phase() != "wall") particles += set->size();
      summary_.particles.emplace_back(set->name(), set->size());
    }
    set_threads(sensible_threads(particles, options_.threads));

    const RunFolder folder(options_.folder, options_.overwrite ? ExistingResults::overwrite : ExistingResults::refuse);
    write_file_atomically(folder.resolved_deck(), resolved_yaml(model_));
    Plan<Dim> plan(world, wishes_of(model_, names));
    Recorder<Dim> recorder(world, plan, folder);
    Stepper<Dim> stepper(world, plan);
    std::string failure;
    try {
      stepper.run(model_.end_time, [&] {
        const double wall = seconds_since(start_);
        recorder.observe(wall, world.clock.time >= model_.end_time);
        progress_.update(progress_of(model_, world.clock, particles, wall));
        return true;
      });
    } catch (const UnstableError& e) {
      failure = e.what();
      recorder.write_frame();
    }
    progress_.clear();
    finish(world, plan, recorder, stepper, folder, failure);
    return summary_.exit_code;
  }

 private:
  void finish(World<Dim>& world, const Plan<Dim>& plan, const Recorder<Dim>& recorder,
              const Stepper<Dim>& stepper, const RunFolder& folder, const std::string& failure) {
    const bool unstable = !failure.empty();
    summary_.expect = evaluate(model_.expect, [&](const std::string& name) { return recorder.series(name); });
    bool met = true;
    for (const ExpectResult& r : summary_.expect) met = met && r.pass;
    summary_.status = unstable ? "unstable" : "done";
    summary_.message = failure;
    summary_.exit_code = static_cast<int>(unstable ? ExitCode::unstable : options_.verify && !met ? ExitCode::mismatch : ExitCode::done);
    summary_.version = version();
    summary_.title = model_.title;
    summary_.deck = options_.deck;
    summary_.deck_hash = deck_hash(model_);
    summary_.dimension = Dim;
    summary_.threads = threads();
    summary_.advection_steps = world.clock.advection_steps;
    summary_.acoustic_steps = world.clock.acoustic_steps;
    summary_.time_s = world.clock.time;
    summary_.wall_s = seconds_since(start_);
    summary_.memory_peak_bytes = peak_memory_bytes();
    std::vector<TimeRow> rows = recorder.time_rows();
    double stepping = stepper.seconds_rearranging();
    rows.push_back({"neighbor_lists", stepper.rearrangements(), stepping, 0});
    for (const auto& e : plan.effects()) {
      rows.push_back({e.info.name, e.calls, e.seconds, 0});
      if (e.info.stage != Stage::observe) stepping += e.seconds;
    }
    summary_.particle_updates_per_s_per_core = stepping > 0 ? stepper.particle_updates() / stepping / threads() : 0;
    summary_.effects = with_rest(std::move(rows), summary_.wall_s);
    summary_.ledger = recorder.ledger();
    summary_.guard.tripped = unstable;
    summary_.guard.reason = failure;
    for (const auto& [name, count] : world.lost())
      summary_.guard.extremes.emplace_back("lost_" + name, static_cast<double>(count));
    write_summary(folder.summary(), summary_);
    report(world);
  }

  void report(const World<Dim>& world) const {
    if (!options_.quiet) {
      std::cerr << render_time_table(summary_.effects);
      std::cerr << fmt::format("{} acoustic steps, {:.3g} million particle updates per second and core on {} thread{}\n",
                               summary_.acoustic_steps, summary_.particle_updates_per_s_per_core / 1e6, summary_.threads,
                               summary_.threads == 1 ? "" : "s");
    }
    for (const auto& [name, count] : world.lost())
      if (count > 0) std::cerr << fmt::format("warning: {} particles of '{}' left the domain and were removed\n", count, name);
    if (!summary_.expect.empty()) std::cout << render_expectations(summary_.expect);
    if (!summary_.message.empty()) std::cerr << "error: " << summary_.message << "\n";
  }

  const Model& model_;
  const RunOptions& options_;
  clock_type::time_point start_;
  Progress progress_;
  Summary summary_;
};

}  // namespace

int sensible_threads(long particles, int asked) {
  if (asked > 0) return asked;
  const long cores = std::max(1u, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp(particles / 2000, 1L, cores));
}

int run_command(const RunOptions& options) {
  const auto start = clock_type::now();
  const Model model = read_deck(options.deck, options.set);
  if (model.dimension == 2) return DeckRun<2>(model, options, start)();
  return DeckRun<3>(model, options, start)();
}

}  // namespace sphgeo
