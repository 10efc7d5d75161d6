#pragma once
// Monitors a running scene and stops it when it has become unstable, with effect, particle,
// position, time and likely cause.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "effects/interface.h"
#include "plan/plan.h"

namespace sphgeo {

/// Checks: every acoustic step, the speed against the speed of sound (which a value that is not a
/// number anywhere in the sums affects within the same step) and the size of the step and of the
/// steps of solids in it; every advection step, all saved fields of sets that move for values that
/// are not finite, the bounds that the effects declare (density, volume fraction), and lost
/// particles; every 16th and before a checkpoint, also sets at rest (whose values are not read
/// again) and particles inside a wall. All throw UnstableError.
template <int Dim>
class Guard {
 public:
  Guard(const World<Dim>& world, const Plan<Dim>& plan);

  /// Before an acoustic step: the limits of the step, and its size, s.
  void before_step(const StepLimits& limits, double dt);
  /// After an advection step, before the rearrangement.
  void after_advection();
  /// All of the state, at any step: before a checkpoint.
  void check_all();

  /// Largest Mach number, smallest and largest density ratio ..., for the summary.
  std::vector<std::pair<std::string, double>> extremes() const;
  /// What the checks took.
  const Spent& spent() const { return spent_; }
  long calls() const { return calls_; }

  void save(StateSink& sink) const;
  void load(const StateSource& source);

 private:
  void check_speed(const StepLimits& limits);
  [[noreturn]] void stop_collapsed(const char* which, double dt, double before,
                                   const StepLimits& limits);
  void check_fields(bool at_rest_too);
  void check_bounds(bool note);
  void check_lost();
  void count_penetrations();
  [[noreturn]] void stop(std::string cause, const ParticleSet<Dim>& set, const FieldSpec& field,
                         Index i, const std::string& what, const std::string& look_for);
  std::string writer_of(const std::string& set, const FieldSpec& field) const;
  Index wall_before(const ParticleSet<Dim>& set, Index i) const;
  std::string suspect(const ParticleSet<Dim>& set, Index i, const std::string& look_for) const;

  const World<Dim>& world_;
  const Plan<Dim>& plan_;
  std::vector<FieldBound> bounds_;
  InterfaceMap<Dim> interface_;
  std::map<std::string, Index> initial_;   ///< particles at the start, by set
  std::map<std::string, Index> in_walls_;  ///< at the latest count, by set
  double largest_dt_ = 0;
  double largest_solid_ = 0;
  double largest_mach_ = 0, water_mach_ = 0;
  double water_mach_time_ = 0;                   ///< when, s
  std::vector<std::pair<double, double>> seen_;  ///< smallest and largest value of each bound
  Spent spent_;
  long calls_ = 0;
};

extern template class Guard<2>;
extern template class Guard<3>;

}  // namespace sphgeo
