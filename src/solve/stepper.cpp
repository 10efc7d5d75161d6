#include "solve/stepper.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sphgeo {

template <int Dim>
bool Stepper<Dim>::run(double end, const RunHooks& hooks) {
  for (;;) {
    if (left_ == 0) {
      rearrange();  // lines 7, 28
      if (!hooks.at_safe_point()) return false;
      if (world_.clock.time >= end) return true;  // line 9
      begin_step();
    }
    if (!advance(hooks)) return false;
    guard_.after_advection();
    if (!hooks.before_rearranging()) return false;
  }
}

template <int Dim>
void Stepper<Dim>::rearrange() {
  plan_.run(Stage::exchange);
  {
    const Stopwatch watch(rearranging_);
    world_.rearrange();
  }
  ++rearrangements_;
  plan_.run(Stage::reinitialize);  // lines 11, 12
}

template <int Dim>
void Stepper<Dim>::begin_step() {
  // Line 10, without the clip to the end of the run: the last step may pass it, so that a run which
  // is continued later takes the same steps as one that was longer from the start.
  world_.clock.dt_advection = left_ = plan_.limits().advection;
  start_ = world_.clock.time;
  world_.clock.in_advection = 0;
}

template <int Dim>
bool Stepper<Dim>::advance(const RunHooks& hooks) {
  Clock& clock = world_.clock;
  while (left_ > 0) {  // line 14
    if (!hooks.before_acoustic_step()) return false;
    const StepLimits limits = plan_.limits();
    // Line 15, with the remainder divided evenly: no very short step at the end.
    const double steps = std::max(1.0, std::ceil(left_ / limits.acoustic - 1e-9));
    const double dt = left_ / steps;
    guard_.before_step(limits, dt);
    acoustic_step(dt, limits.solid);  // lines 16 to 25
    left_ = steps == 1 ? 0 : left_ - dt;
    clock.time = left_ == 0 ? start_ + clock.dt_advection : clock.time + dt;  // line 26
  }
  ++clock.advection_steps;
  return true;
}

template <int Dim>
void Stepper<Dim>::acoustic_step(double dt, double solid_limit) {
  world_.clock.dt_acoustic = dt;
  world_.clock.in_advection += dt;
  plan_.run(Stage::predict);  // Eq. 96
  plan_.run(Stage::force);    // Eq. 60
  plan_.run(Stage::kick);     // Eqs. 97, 98
  // Algorithm 2 moves the solids last. Water and soil would then be compressed by the solids of the
  // previous step, and this delay adds energy to lighter solids (see light_solids.h).
  if (solid_limit < std::numeric_limits<double>::infinity()) solid_steps(dt, solid_limit);
  plan_.run(Stage::rate);     // Eq. 58
  plan_.run(Stage::correct);  // Eq. 98
  ++world_.clock.acoustic_steps;
  for (const auto& set : world_.sets())
    if (set->phase() == "water" || set->phase() == "soil")
      particle_updates_ += static_cast<double>(set->size());
}

// Lines 19 to 25. Their number is fixed here, so that the average of Eq. 95 is exact.
template <int Dim>
void Stepper<Dim>::solid_steps(double dt, double limit) {
  Clock& clock = world_.clock;
  clock.solid_steps_each = static_cast<int>(std::clamp(std::ceil(dt / limit - 1e-9), 1.0, 1e9));
  clock.dt_solid = dt / clock.solid_steps_each;
  for (clock.solid_step = 0; clock.solid_step < clock.solid_steps_each; ++clock.solid_step) {
    plan_.run(Stage::solid_predict);  // Eq. 99
    plan_.run(Stage::solid_force);    // Eq. 65
    plan_.run(Stage::solid_kick);     // Eqs. 100, 101
    ++clock.solid_steps;
    for (const auto& set : world_.sets())
      if (set->phase() == "solid") particle_updates_ += static_cast<double>(set->size());
  }
  clock.solid_step = 0;
  plan_.run(Stage::solid_finish);
}

template <int Dim>
void Stepper<Dim>::save(StateSink& sink) const {
  put_spent(sink, "stepper/rearranging", rearranging_);
  sink.put_number("stepper/particle_updates", particle_updates_);
  sink.put_count("stepper/rearrangements", rearrangements_);
  guard_.save(sink);
  sink.put_number("stepper/left", left_);
  if (left_ == 0) return;
  sink.put_number("stepper/start", start_);
  world_.save_arrangement(sink);
  plan_.save_within_step(sink);
}

template <int Dim>
void Stepper<Dim>::load(const StateSource& source) {
  rearranging_ = spent_of(source, "stepper/rearranging");
  particle_updates_ = source.number("stepper/particle_updates");
  rearrangements_ = source.count("stepper/rearrangements");
  guard_.load(source);
  left_ = source.number("stepper/left");
  if (left_ == 0) return;
  start_ = source.number("stepper/start");
  world_.load_arrangement(source);
  const double now = std::exchange(world_.clock.time, start_);
  plan_.load_within_step(source);
  world_.clock.time = now;
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace sphgeo
