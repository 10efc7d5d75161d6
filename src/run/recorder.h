#pragma once
// Output during a run: probe series, frames, run.csv. It does not change the state. Frames are
// composed while the run waits, and written beside it.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/side_thread.h"
#include "deck/model.h"
#include "output/run_folder.h"
#include "output/series.h"
#include "output/summary.h"
#include "plan/plan.h"
#include "probes/probe.h"
#include "probes/set_sums.h"
#include "run/frame_output.h"

namespace sphgeo {

/// Times at which something is due: every multiple of an interval, taken at the first safe point
/// past it.
class Schedule {
 public:
  explicit Schedule(double interval) : interval_(interval) {}
  bool due(double time) const { return time >= next_ - 1e-12 * interval_; }
  /// Moves on to the first multiple after `time`.
  void done(double time);
  double next() const { return next_; }
  void set_next(double time) { next_ = time; }

 private:
  double interval_;
  double next_ = 0;
};

template <int Dim>
class Recorder {
 public:
  /// Opens all files; with `resume` it continues existing ones, cut back to the checkpoint.
  /// `walls` are the boundaries of the model. Throws IoError.
  Recorder(const Model& model, World<Dim>& world, Plan<Dim>& plan, const BoundaryMesh& walls,
           const RunFolder& folder, const StateSource* resume = nullptr);

  /// Hands all rows to the system, then saves the length of each file.
  void save(StateSink& sink);
  /// Waits until these rows are on the disk; in any thread.
  void wait_for_disk() const;

  /// At a safe point: samples whatever is due; `last` takes a row of everything. Throws IoError,
  /// also for what was to be written before.
  void observe(double wall_seconds, bool last);
  /// Waits until all files are on the disk. Throws IoError, so that what is lost is reported.
  void flush();
  /// Begins a frame of the present state, independent of the schedule (post-mortem).
  void write_frame() { frames_.write(); }
  /// Where frames and checkpoints are written, in the order of their times. One at a time, which is
  /// the memory that it takes.
  SideThread& files() { return files_; }

  const Series* series(const std::string& probe) const;
  /// Rows for the time table.
  std::vector<TimeRow> time_rows() const;
  /// Mass, momentum and energy at the start and at the latest row of run.csv.
  std::vector<LedgerRow> ledger() const;

 private:
  struct ProbeRun {
    std::shared_ptr<const Probe> probe;
    Schedule schedule;
    std::unique_ptr<Series> series;
  };
  /// Numbers only: a checkpoint keeps them as an array.
  struct Totals {
    double time = 0;
    double mass = 0, kinetic = 0, potential = 0, internal = 0;
    std::array<double, 3> momentum{};
    double max_speed = 0, min_density = 0, max_density = 0;
    double dissipated = 0, min_fraction = 0, max_fraction = 0;  ///< of soil
    double water_volume = 0,
           mixture_volume = 0;          ///< sum of m / rho and of V, where water meets soil
    double mass_in = 0, energy_in = 0;  ///< inflow minus outflow through boundaries
    std::array<double, 3> momentum_in{};
  };
  using TotalsArray = std::array<double, sizeof(Totals) / sizeof(double)>;

  void load(const StateSource& source);
  void sample_probe(ProbeRun& p);
  void sample_run(double wall_seconds);
  Totals totals() const;
  void add_soil_totals(const ParticleSet<Dim>& soil, Totals& sum) const;
  static void add_set_totals(const ParticleSet<Dim>& set, const Energies& e, Totals& sum);

  const Model& model_;
  World<Dim>& world_;
  Plan<Dim>& plan_;
  std::vector<ProbeRun> probes_;
  Schedule frame_times_, rows_;
  Series run_;
  std::optional<Totals> first_, latest_;
  Spent spent_probes_;
  long calls_probes_ = 0;
  FrameOutput<Dim> frames_;
  SideThread files_;  ///< last: its tasks use the others
};

extern template class Recorder<2>;
extern template class Recorder<3>;

}  // namespace sphgeo
