#pragma once
// A deck, run to its end: its scene is built and planned, the steps are taken, and all files of the
// run folder are written but the report. Nothing is printed here: an observer is told.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostic.h"
#include "deck/model.h"
#include "output/progress.h"
#include "output/run_folder.h"
#include "output/summary.h"

namespace sphgeo {

/// What a run is asked for beside its deck.
struct RunSettings {
  std::string deck;    ///< the path of the deck, for the summary
  std::string folder;  ///< of the results; made when it is missing
  /// `resume` continues from the checkpoint in the folder, and starts anew when there is none.
  ExistingResults existing = ExistingResults::refuse;
  int threads = 0;      ///< 0: a sensible number for the scene
  bool verify = false;  ///< a missed `expect` makes the exit code of the summary `mismatch`
  /// Wall time counts from here: earlier than now when the deck was read before.
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

/// The progress of a run in this process, when it asks whether to continue.
struct RunPosition {
  double wall_seconds = 0;
  double reserve_seconds = 0;           ///< wall time to stop, checkpoint included
  std::optional<long> advection_steps;  ///< known between two of them only
  long acoustic_steps = 0;
};

/// Follows a run from outside. What is not overridden does nothing; all of it is called in the
/// thread that runs the deck, and what it throws ends the run.
class RunObserver {
 public:
  RunObserver() = default;
  virtual ~RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;

  /// Findings about the deck that are no errors; not called when there are none.
  virtual void findings(const Diagnostics&) {}
  /// A problem that does not stop the run, as half a sentence.
  virtual void warning(const std::string&) {}
  /// How the scene was made, as half a sentence.
  virtual void note(const std::string&) {}
  /// The scene is built and the folder prepared: from now on the run can be stopped and resumed.
  virtual void begins(const RunFolder&) {}
  /// The run continues from a checkpoint, at a time (s) and a number of advection steps.
  virtual void resumes(double /*time*/, Index /*steps*/, const std::string& /*checkpoint*/) {}
  /// At every safe point.
  virtual void progress(const ProgressState&) {}
  /// Why to end now, before every acoustic step; "" to continue. The run writes a checkpoint and
  /// ends.
  virtual std::string stop_reason(const RunPosition&) { return ""; }
};

/// The result of a run. The folder is locked against other runs during its lifetime.
struct RunResult {
  std::unique_ptr<FolderLock> lock;
  RunFolder folder;
  Summary summary;                                  ///< as it was written to the folder
  std::vector<std::pair<std::string, Index>> lost;  ///< particles that left the domain, by set
};

/// Runs the deck to its end time, or until the guard or the observer ends it. The summary tells
/// which: a run that became unstable or was stopped returns like any other. Sets the number of
/// threads of the process. Throws DeckError (also when the scene does not fit into the memory, or
/// the checkpoint belongs to another deck), Error (usage) when the folder is taken, IoError.
RunResult run_deck(const Model& model, const RunSettings& settings, RunObserver& observer);

}  // namespace sphgeo
