#pragma once
// The forecast of a deck, put together for `check` and for `run`, and the refusal of a scene that
// the machine has no memory for.

#include <memory>
#include <optional>

#include "core/stopwatch.h"
#include "output/cost_figures.h"
#include "output/time_table.h"
#include "run/run_output.h"
#include "solve/run_cost.h"

namespace sphgeo {

/// Throws DeckError when the scene needs more memory than there is, before any particle is placed:
/// with what is needed, what is available and which resolution would fit.
void refuse_too_large(const Model& model);

/// Measured costs that the forecast of the time rests on, s: on a machine with nothing else to do.
struct MeasuredCosts {
  double start = 0;  ///< from the start of the program to the first step
  StepCost step;
  double observation = 0;  ///< of probes and the effects that serve them, each time
  double frame = 0;
};

/// Input of the forecast, taken from a world after a rearrangement. The world is not changed.
/// `base` is the memory of the process before it had any particles, bytes: program, libraries,
/// deck. `asked_threads` are those that the user asked for, also at other spacings; 0: as many as
/// suit.
struct ForecastBasis {
  template <int Dim>
  ForecastBasis(const Model& model, World<Dim>& world, const Plan<Dim>& plan,
                const SoundSpeed& sound, const std::vector<Wish>& wishes, const BoundaryMesh& walls,
                std::uint64_t base, int asked_threads);

  /// The forecast for the threads in use; without the time when no costs are given.
  Forecast operator()(const std::optional<MeasuredCosts>& costs) const;
  double advection_steps() const { return steps_.advection; }

 private:
  RunFigures figures(double coarser, const ParticleCounts& at, int with_threads,
                     const std::optional<MeasuredCosts>& costs) const;

  const Model& model_;
  int asked_threads_;
  ParticleCounts counts_;
  std::vector<MemoryShare> shares_;
  double base_;
  StepCounts steps_;
  RunOutput output_;
};

/// Costs from a few real steps, probes and frames that are not kept: about a second, or as long as
/// a run of `steps` advection steps. Advances the world, or a coarser copy of it when a step would
/// take too long. None when the scene becomes unstable in these steps.
template <int Dim>
std::optional<MeasuredCosts> measure_costs(const Model& model, World<Dim>& world, Plan<Dim>& plan,
                                           const std::vector<Wish>& wishes,
                                           const BoundaryMesh& walls, double start, double steps);

/// The forecast that a run makes: all but the time before its first step, the time from its own
/// first steps. It measures at negligible cost and changes nothing.
template <int Dim>
class RunForecast {
 public:
  /// `base` and `asked_threads` as in ForecastBasis; `starting` counts what comes before the first
  /// step.
  RunForecast(const Model& model, World<Dim>& world, const Plan<Dim>& plan,
              const Stepper<Dim>& stepper, SoundSpeed sound, std::vector<Wish> wishes,
              const BoundaryMesh& walls, std::uint64_t base, int asked_threads,
              std::unique_ptr<QuietWatch> starting)
      : model_(model),
        world_(world),
        plan_(plan),
        sound_(std::move(sound)),
        wishes_(std::move(wishes)),
        walls_(walls),
        base_(base),
        asked_threads_(asked_threads),
        starting_(std::move(starting)),
        timer_(world, plan, stepper) {}

  /// At the beginning of every safe point.
  void arrive();
  /// At the end of every safe point; `rows` are those of the recorder.
  void leave(const std::vector<TimeRow>& rows);
  /// None when the run never came to its first step.
  std::optional<Forecast> result() const;

 private:
  const Model& model_;
  World<Dim>& world_;
  const Plan<Dim>& plan_;
  SoundSpeed sound_;
  std::vector<Wish> wishes_;
  const BoundaryMesh& walls_;
  std::uint64_t base_;
  int asked_threads_;
  std::unique_ptr<QuietWatch> starting_;  ///< until the first step
  StepTimer<Dim> timer_;
  MeasuredCosts costs_;
  std::optional<ForecastBasis> basis_;
  bool settled_ = false;
};

extern template class RunForecast<2>;
extern template class RunForecast<3>;

}  // namespace sphgeo
