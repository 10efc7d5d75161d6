#pragma once
// The planner: what is present and what is asked decide which effects run, in which order, with
// which fields and neighbor lists. A tiny make.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "effects/effect.h"
#include "plan/record_plan.h"

namespace sphgeo {

/// A field that a probe or a frame wants.
struct Wish {
  std::string set, field, who;
  bool optional = false;  ///< no error when no effect computes it
};

/// One active effect with its clockwork.
template <int Dim>
struct PlannedEffect {
  EffectInfo info;
  std::unique_ptr<Effect<Dim>> effect;
  Needs needs;
  std::string because;
  std::string label;  ///< the name, with what it acts on where several bear it: for time tables and
                      ///< checkpoints
  long calls = 0;
  Spent spent = {};
  /// Where all its pairs are between two sets: the first of its lists, and the particles that it
  /// has met in all calls. Only these are walked; the others of the set are far from the source.
  std::string walked_set = {};
  const NeighborList* walked_list = nullptr;
  double walked = 0, in_set = 0;
};

struct UnusedEffect {
  std::string name, because;
};

template <int Dim>
class Plan {
 public:
  /// Binds all registered effects to the world, allocates the union of their fields and records,
  /// declares the union of their lists and orders them. Throws std::logic_error that names effect,
  /// set and field (or record) when a derived field or a record has no producer or two in one
  /// stage, or when writers and readers form a cycle.
  Plan(World<Dim>& world, const std::vector<Wish>& wishes);

  /// Runs all effects of the stage, timing each.
  void run(Stage stage);
  StepLimits limits() const;
  /// What the active effects want watched.
  std::vector<FieldBound> bounds() const;
  /// Memory that the effects keep beside fields and lists [bytes].
  std::size_t bytes() const;

  const std::vector<PlannedEffect<Dim>>& effects() const { return effects_; }
  const std::vector<UnusedEffect>& unused() const { return unused_; }
  /// What they do with packed records, in the order of running.
  std::vector<EffectRecords> records() const;

  /// What effects keep from step to step; calls and seconds of the time table, so that they go on
  /// after a restart.
  void save(StateSink& sink) const;
  void load(const StateSource& source);

  /// Within an advection step: the derived fields that its acoustic steps find ready from the
  /// reinitialize stage. Loading also restores what that stage left outside of the fields; the
  /// clock must show the start of the step.
  void save_within_step(StateSink& sink) const;
  void load_within_step(const StateSource& source);

 private:
  std::vector<std::pair<std::string, FieldBase*>> ready_fields() const;
  void bind(const std::vector<Wish>& wishes);
  void check_producers(const std::vector<Wish>& wishes) const;
  void order();

  World<Dim>& world_;
  std::vector<PlannedEffect<Dim>> effects_;  // by stage, then order of running
  std::vector<UnusedEffect> unused_;
};

extern template class Plan<2>;
extern template class Plan<3>;

}  // namespace sphgeo
