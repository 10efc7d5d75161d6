#pragma once
// Cost of a run: memory by the set it grows with, the number of steps, and the time of a step
// measured on the run's own particles, without results of the run.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "scene/build.h"
#include "scene/particle_count.h"
#include "solve/stepper.h"

namespace sphgeo {

/// A part of the memory, and the particle set that it grows with ("" for none).
struct MemoryShare {
  std::string what, set;
  double bytes;
};

/// Fields, records, grids, neighbor lists and the scratch of effects, as they are allocated now;
/// complete after a rearrangement.
template <int Dim>
std::vector<MemoryShare> memory_shares(const World<Dim>& world, const Plan<Dim>& plan);

/// Their sum in a scene of `to` particles when they were taken in one of `from`.
double bytes_at(const std::vector<MemoryShare>& shares, const ParticleCounts& from,
                const ParticleCounts& to);

/// Particles of each set, now.
template <int Dim>
ParticleCounts counts_of(const World<Dim>& world);

struct StepCounts {
  double advection = 0, acoustic = 0;
};

/// The expected largest speed of the particles, on average over a run, m/s.
template <int Dim>
double typical_speed(const World<Dim>& world, const SoundSpeed& sound);

/// Steps of both clocks through `duration` (s) when the fastest particle of every set moves at
/// `speed` (m/s): the bounds are those of the plan itself. The world is not changed (bitwise).
template <int Dim>
StepCounts expected_steps(World<Dim>& world, const Plan<Dim>& plan, double speed, double duration);

/// Seconds of wall time, on a machine with nothing else to do.
struct StepCost {
  double advection = 0;  ///< of a rearrangement with its reinitialization
  double acoustic = 0;   ///< of an acoustic step
  double slowdown = 1;   ///< by what else the machine did: wall time as it was over that
  double of(const StepCounts& n) const { return n.advection * advection + n.acoustic * acoustic; }
};

/// Times advection steps, by processor time: a forecast made on a busy machine is not worse. The
/// first one is left out, as its memory is not in caches.
template <int Dim>
class StepTimer {
 public:
  StepTimer(const World<Dim>& world, const Plan<Dim>& plan, const Stepper<Dim>& stepper)
      : world_(world), plan_(plan), stepper_(stepper) {}

  /// At the end of a safe point.
  void begin();
  /// At the next safe point, before anything else; nothing unless a step has begun.
  void end();

  std::size_t steps() const { return samples_.size(); }
  double seconds() const { return seconds_; }  ///< of all steps so far
  /// None before the second step has ended.
  std::optional<StepCost> cost() const;

 private:
  using clock = std::chrono::steady_clock;
  /// Seconds spent by the stepper once per advection step.
  double between() const;

  struct Sample {
    double all, between;  ///< wall time, s
    double quiet;
    long acoustic_steps;
  };
  const World<Dim>& world_;
  const Plan<Dim>& plan_;
  const Stepper<Dim>& stepper_;
  std::optional<clock::time_point> begun_;
  std::optional<QuietWatch> watch_;
  double between_ = 0, seconds_ = 0;
  long acoustic_ = 0;
  std::vector<Sample> samples_;
};

/// Real steps of the plan for about `seconds`, at most `most_steps` but at least 3. Advances the
/// world.
template <int Dim>
std::optional<StepCost> calibrate(World<Dim>& world, Plan<Dim>& plan, double seconds,
                                  double most_steps);

}  // namespace sphgeo
