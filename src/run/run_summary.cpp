#include "run/run_summary.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/version.h"
#include "run/relaxation_report.h"

namespace sphgeo {
namespace {

/// Effects and what the stepper does beside them; returns the time of the steps, s.
template <int Dim>
double add_times(const RunParts<Dim>& parts, const Keeper<Dim>& keeper, Summary& summary) {
  const Stepper<Dim>& stepper = parts.stepper;
  std::vector<TimeRow> rows = parts.recorder.time_rows();
  double stepping = stepper.rearranging().seconds;
  rows.push_back({"neighbor_lists", stepper.rearrangements(), stepper.rearranging()});
  rows.push_back({"guard", stepper.guard().calls(), stepper.guard().spent()});
  rows.push_back({"checkpoints", keeper.count(), keeper.spent()});
  for (const auto& e : parts.plan.effects()) {
    rows.push_back(
        {e.label, e.calls, e.spent, e.walked_set, e.in_set > 0 ? e.walked / e.in_set : 0});
    summary.plan.push_back(
        {stage_name(e.info.stage), e.info.name, e.info.equations, e.effect->acts_on(), e.because});
    if (e.info.stage != Stage::observe) stepping += e.spent.seconds;
  }
  const Spent whole = keeper.so_far(summary.wall_s - keeper.wall_before());
  summary.busy = whole.busy();
  summary.effects = with_rest(std::move(rows), whole);
  return stepping;
}

void add_failure(const UnstableError& failure, GuardReport& guard) {
  const Instability& where = failure.instability;
  guard.tripped = true;
  guard.reason = failure.what();
  guard.cause = where.cause;
  guard.effect = where.effect;
  guard.set = where.set;
  guard.particle = where.particle;
  guard.place = where.place;
  guard.time = where.time;
}

}  // namespace

template <int Dim>
void summarize(const Model& model, const RunParts<Dim>& parts, const Keeper<Dim>& keeper,
               bool verify, const RunEnd& end, Summary& summary) {
  const World<Dim>& world = parts.world;
  summary.expect = evaluate(relaxation_expects(model, false),
                            [&](const std::string& name) { return parts.recorder.series(name); });
  const bool met = std::all_of(summary.expect.begin(), summary.expect.end(),
                               [](const ExpectResult& r) { return r.pass; });
  const bool stopped = !end.failure && !end.stopped.empty();
  summary.status = end.failure ? "unstable" : stopped ? "stopped" : "done";
  summary.message = end.failure ? end.failure->what() : end.stopped;
  summary.exit_code = static_cast<int>(end.failure      ? ExitCode::unstable
                                       : stopped        ? ExitCode::stopped
                                       : verify && !met ? ExitCode::mismatch
                                                        : ExitCode::done);
  summary.version = version();
  summary.title = model.title;
  summary.deck_hash = deck_hash(model);
  summary.dimension = Dim;
  // As they are now: the settings at the start are not known to a resumed run.
  for (const auto& set : world.sets()) summary.particles.emplace_back(set->name(), set->size());
  summary.threads = threads();
  summary.advection_steps = world.clock.advection_steps;
  summary.acoustic_steps = world.clock.acoustic_steps;
  summary.solid_steps = world.clock.solid_steps;
  summary.time_s = world.clock.time;
  summary.memory_peak_bytes = peak_memory_bytes();
  const double stepping = add_times(parts, keeper, summary);
  summary.particle_updates_per_s_per_core =
      stepping > 0 ? parts.stepper.particle_updates() / stepping / threads() : 0;
  summary.ledger = parts.recorder.ledger();
  summary.checkpoint = {keeper.count(), keeper.seconds(), keeper.bytes()};
  summary.guard.extremes = parts.stepper.guard().extremes();
  if (end.failure) add_failure(*end.failure, summary.guard);
}

template void summarize<2>(const Model&, const RunParts<2>&, const Keeper<2>&, bool, const RunEnd&,
                           Summary&);
template void summarize<3>(const Model&, const RunParts<3>&, const Keeper<3>&, bool, const RunEnd&,
                           Summary&);

}  // namespace sphgeo
