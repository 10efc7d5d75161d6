#pragma once
// Writes checkpoints during a run, and restores them.

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

/// When to write checkpoints, and their cost.
template <int Dim>
class Keeper {
 public:
  /// `wall_before` is the wall time of earlier parts of this run, s.
  Keeper(RunParts<Dim> parts, const RunFolder& folder, double wall_before);

  /// Writes a checkpoint if one is due. `wall_seconds` since this process began.
  void keep_if_due(double wall_seconds);
  /// Writes one now, after the guard has checked the whole state. Throws UnstableError, IoError.
  void keep(double wall_seconds);

  double wall_before() const { return wall_before_; }  ///< s
  double last_seconds() const { return last_seconds_; }
  double seconds() const { return seconds_; }
  long count() const { return count_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  RunParts<Dim> parts_;
  const RunFolder& folder_;
  double wall_before_;
  double written_at_ = 0;  ///< wall time of this process, s
  double last_seconds_ = 0, seconds_ = 0;
  long count_ = 0;
  std::uint64_t bytes_ = 0;
};

/// Throws DeckError when the checkpoint belongs to another deck, with the keys that differ.
void require_same_deck(const Model& model, const CheckpointReader& checkpoint);

extern template class Keeper<2>;
extern template class Keeper<3>;

}  // namespace sphgeo
