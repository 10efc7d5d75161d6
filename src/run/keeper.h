#pragma once
// Keeps checkpoints during a run, and restores them.

#include <atomic>
#include <memory>
#include <string>

#include "deck/model.h"
#include "output/checkpoint.h"
#include "run/recorder.h"
#include "solve/stepper.h"

namespace sphgeo {

/// The state of a run that a checkpoint holds.
template <int Dim>
struct RunParts {
  const Model& model;
  World<Dim>& world;
  Plan<Dim>& plan;
  Stepper<Dim>& stepper;
  Recorder<Dim>& recorder;
};

/// When to write checkpoints, and their cost. The state is copied while the run waits; the file is
/// written beside it, in order with the frames.
template <int Dim>
class Keeper {
 public:
  /// `before` is what earlier parts of this run took; the processor time of this part is that of
  /// the process from `processor_start` on, s.
  Keeper(RunParts<Dim> parts, const RunFolder& folder, const Spent& before, double processor_start);

  /// Begins a checkpoint if one is due. `wall_seconds` since this process began.
  void keep_if_due(double wall_seconds);
  /// Begins one now, after the guard has checked the whole state. Throws UnstableError, IoError.
  void keep(double wall_seconds);

  double wall_before() const { return before_.seconds; }  ///< s
  /// Of this part of the run, `wall_seconds` long so far, and those before, without the thread that
  /// writes files beside it.
  Spent so_far(double wall_seconds) const {
    Spent all = before_;
    return all += {.seconds = wall_seconds,
                   .processor = processor_seconds() - processor_start_ -
                                parts_.recorder.files().processor_seconds(),
                   .offered = wall_seconds * threads()};
  }
  /// From the start of the last one until it was on the disk; what is still being written counts as
  /// the one before it, s.
  double last_seconds() const { return last_held_up_ + writing_->last; }
  /// The same for all of them, s.
  double seconds() const { return spent_.seconds + writing_->all; }
  /// What the run waited for.
  const Spent& spent() const { return spent_; }
  long count() const { return count_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  /// Time that files took beside the run, s; set by the thread that writes.
  struct Writing {
    std::atomic<double> last = 0, all = 0;
  };
  void begin(double wall_seconds);

  RunParts<Dim> parts_;
  const RunFolder& folder_;
  Spent before_;
  double processor_start_;
  double kept_at_ = 0;  ///< wall time of this process, s
  double last_held_up_ = 0;
  std::shared_ptr<Writing> writing_ = std::make_shared<Writing>();
  Spent spent_;
  long count_ = 0;
  std::uint64_t bytes_ = 0;
};

/// Throws DeckError when the checkpoint belongs to another deck, with the keys that differ.
void require_same_deck(const Model& model, const CheckpointReader& checkpoint);

extern template class Keeper<2>;
extern template class Keeper<3>;

}  // namespace sphgeo
