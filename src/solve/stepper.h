#pragma once
// The loop of Algorithm 2. No physics: effects move the particles, and bound the steps.

#include <functional>

#include "plan/plan.h"
#include "solve/guard.h"

namespace sphgeo {

/// Hooks beside the steps, for output and checkpoints; they do not change the state.
struct RunHooks {
  /// At the start and after every advection step, with lists and derived fields fresh. False: stop.
  std::function<bool()> at_safe_point;
  /// Between an advection step and the rearrangement that follows it: the rest of the run depends
  /// only on the present contents of the sets. False: stop before the rearrangement, as a resumed
  /// run begins with it.
  std::function<bool()> before_rearranging = [] { return true; };
  /// Before an acoustic step: the run can be saved here too. False: stop within the advection step.
  std::function<bool()> before_acoustic_step = [] { return true; };
};

template <int Dim>
class Stepper {
 public:
  Stepper(World<Dim>& world, Plan<Dim>& plan) : world_(world), plan_(plan), guard_(world, plan) {}

  /// Runs until the first safe point at or after `end` (s), or until a hook says stop; returns
  /// whether it got to the end. Throws UnstableError when the guard stops it.
  bool run(double end, const RunHooks& hooks);

  Guard<Dim>& guard() { return guard_; }
  const Guard<Dim>& guard() const { return guard_; }

  /// The counters below and the guard's.
  /// Within an advection step also its remaining time, and the data of its acoustic steps:
  /// loading, after the world, rebuilds lists and records, and run() begins with the next acoustic
  /// step.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

  /// What the rearrangements took.
  const Spent& rearranging() const { return rearranging_; }
  long rearrangements() const { return rearrangements_; }
  /// Particles times acoustic steps since t = 0: the unit of work of the speed figures.
  double particle_updates() const { return particle_updates_; }

 private:
  void rearrange();
  void begin_step();
  bool advance(const RunHooks& hooks);
  void acoustic_step(double dt, double solid_limit);
  void solid_steps(double dt, double limit);

  World<Dim>& world_;
  Plan<Dim>& plan_;
  Guard<Dim> guard_;
  double start_ = 0, left_ = 0;  ///< of the advection step: its start, and the remaining time,
                                 ///< s; 0 between two steps
  Spent rearranging_;
  double particle_updates_ = 0;
  long rearrangements_ = 0;
};

extern template class Stepper<2>;
extern template class Stepper<3>;

}  // namespace sphgeo
