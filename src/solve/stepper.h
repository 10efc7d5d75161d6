#pragma once
// The loop of Algorithm 2. No physics: effects move the particles, and bound the steps.

#include <functional>

#include "plan/plan.h"

namespace sphgeo {

template <int Dim>
class Stepper {
 public:
  Stepper(World<Dim>& world, Plan<Dim>& plan) : world_(world), plan_(plan) {}

  /// Runs until the first safe point at or after `end` (s). `at_safe_point` is called at the start and
  /// after every advection step, with lists and derived fields fresh; it returns false to stop.
  void run(double end, const std::function<bool()>& at_safe_point);

  double seconds_rearranging() const { return seconds_rearranging_; }
  long rearrangements() const { return rearrangements_; }
  /// Particles times acoustic steps so far: the unit of work of the speed figures.
  double particle_updates() const { return particle_updates_; }

 private:
  void rearrange();
  void advance();
  void acoustic_step(double dt);

  World<Dim>& world_;
  Plan<Dim>& plan_;
  double seconds_rearranging_ = 0;
  double particle_updates_ = 0;
  long rearrangements_ = 0;
};

extern template class Stepper<2>;
extern template class Stepper<3>;

}  // namespace sphgeo
