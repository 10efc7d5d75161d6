#pragma once
// The three nested clocks of Algorithm 2.

#include "core/state_io.h"

namespace sphgeo {

/// Times of the running steps, and how many steps there were.
struct Clock {
  double time = 0;           ///< s
  double dt_acoustic = 0;    ///< of the running acoustic step, s
  double dt_advection = 0;   ///< of the running advection step, s
  double in_advection = 0;   ///< from the start of the advection step to the end of the acoustic
                             ///< step, s
  double dt_solid = 0;       ///< of the running step of solids within it, s
  int solid_step = 0;        ///< its number within the acoustic step, from 0
  int solid_steps_each = 1;  ///< how many there are in the acoustic step, kappa
  long advection_steps = 0;
  long acoustic_steps = 0;
  long solid_steps = 0;

  /// Begin of the running step of solids, s.
  double solid_time() const { return time + solid_step * dt_solid; }
  /// Weight of the running acoustic step in a mean over the advection step so far: with
  /// mean += share (value - mean) in each of them, the first one replaces the mean of the step
  /// before.
  double share_of_mean() const { return in_advection > 0 ? dt_acoustic / in_advection : 1; }
  /// The same of the running step of solids.
  double solid_share_of_mean() const {
    const double so_far = in_advection - dt_acoustic + (solid_step + 1) * dt_solid;
    return so_far > 0 ? dt_solid / so_far : 1;
  }

  /// Between two acoustic steps; the step of solids is chosen anew then.
  void save(StateSink& sink) const {
    sink.put_number("clock/time", time);
    sink.put_number("clock/dt_acoustic", dt_acoustic);
    sink.put_number("clock/dt_advection", dt_advection);
    sink.put_number("clock/in_advection", in_advection);
    sink.put_count("clock/advection_steps", advection_steps);
    sink.put_count("clock/acoustic_steps", acoustic_steps);
    sink.put_count("clock/solid_steps", solid_steps);
  }
  void load(const StateSource& source) {
    time = source.number("clock/time");
    dt_acoustic = source.number("clock/dt_acoustic");
    dt_advection = source.number("clock/dt_advection");
    in_advection = source.number("clock/in_advection");
    advection_steps = source.count("clock/advection_steps");
    acoustic_steps = source.count("clock/acoustic_steps");
    solid_steps = source.count("clock/solid_steps");
  }
};

}  // namespace sphgeo
