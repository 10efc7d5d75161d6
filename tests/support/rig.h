#pragma once
// A scene that runs: read from deck text, built, planned and arranged, with its parts in reach.

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "plan/plan.h"
#include "probes/probe.h"
#include "scene/build.h"
#include "scene/world_view.h"
#include "solve/stepper.h"

namespace sphgeo::test {

/// Reads and builds the deck; `plan_it` comes later, so that a test can move particles before.
template <int Dim>
struct Rig {
  Model model;
  Diagnostics found;
  Scene<Dim> scene;
  World<Dim>& world;
  std::unique_ptr<Plan<Dim>> plan;
  std::unique_ptr<Stepper<Dim>> stepper;

  explicit Rig(const std::string& deck, const std::vector<std::string>& overrides = {})
      : model(read_deck_text(deck, overrides)),
        scene(build_scene<Dim>(model, found)),
        world(*scene.world) {
    // Scenes of tests are so small that threads only wait for each other.
    set_threads(1);
    CAPTURE(found.render());
    REQUIRE_FALSE(found.has_errors());
  }
  ~Rig() { set_threads(threads_before_); }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  ParticleSet<Dim>& water() { return world.set("water"); }
  ParticleSet<Dim>& soil() { return world.set("soil"); }
  ParticleSet<Dim>& walls() { return world.set("walls"); }

  /// Moves every water particle by up to `by` spacings, the same way in every run.
  void jitter(double by, std::uint64_t seed = 5) { jitter_set("water", by, seed); }
  void jitter_set(const std::string& set, double by, std::uint64_t seed = 5) {
    auto& x = world.set(set).vector(fields::position);
    for (Index i = 0; i < x.size(); ++i)
      for (int k = 0; k < Dim; ++k)
        x[i][k] += by * world.set(set).spacing() *
                   (2 * random_uniform(seed, static_cast<std::uint64_t>(Dim * i + k)) - 1);
  }

  /// Plans for the deck's probes and for `wishes`, and arranges the particles.
  void plan_it(std::vector<Wish> wishes = {}) {
    for (const auto& p : model.probes)
      for (const FieldRequest& r : dynamic_cast<const Probe&>(*p).needs(model))
        if (!r.optional || world.find(r.set))
          wishes.push_back({r.set, r.field->name, "probe " + p->name, r.optional});
    plan = std::make_unique<Plan<Dim>>(world, wishes);
    stepper = std::make_unique<Stepper<Dim>>(world, *plan);
    arrange();
  }
  void arrange() {
    world.rearrange();
    plan->run(Stage::reinitialize);
  }

  /// Fills records, pressure and volume of the water from its density, without moving anything.
  void freeze() {
    world.clock.dt_acoustic = 0;
    plan->run(Stage::predict);
  }

  /// One effect, whatever its stage.
  void apply(const std::string& name) {
    for (const auto& e : plan->effects())
      if (e.info.name == name) return e.effect->apply(world);
    throw std::logic_error("the plan has no effect " + name);
  }

  /// Runs this many advection steps.
  void advance(long steps) {
    long left = steps;
    stepper->run(1e9, {[&] { return left-- > 0; }});
  }
  /// Runs advection steps until at least so many acoustic steps are done.
  void advance_acoustic(long steps) {
    stepper->run(1e9, {[&] { return world.clock.acoustic_steps < steps; }});
  }

  /// The current values of probe k of the deck.
  std::vector<std::optional<double>> sample(std::size_t k) const {
    const auto& probe = dynamic_cast<const Probe&>(*model.probes[k]);
    std::vector<std::optional<double>> out(probe.columns(model).size());
    probe.sample(WorldView<Dim>(model, world), out);
    return out;
  }

  /// Every field of every set as one number: equal only if all bits are.
  std::uint64_t checksum(bool derived_too = false) const {
    std::uint64_t sum = fnv1a_start;
    const auto add = [&](const void* data, std::size_t bytes) {
      sum = fnv1a_bytes(data, bytes, sum);
    };
    for (const auto& set : world.sets())
      for (const auto& [name, field] : set->fields()) {
        if (!derived_too && field->spec().lifetime == Lifetime::derived) continue;
        const auto n = static_cast<std::size_t>(set->size());
        switch (field->spec().type) {
          case FieldType::scalar:
            add(set->scalar(field->spec()).data(), n * sizeof(double));
            break;
          case FieldType::vector:
            add(set->vector(field->spec()).data(), n * sizeof(Vec<Dim>));
            break;
          case FieldType::tensor:
            add(set->tensor(field->spec()).data(), n * sizeof(Sym3));
            break;
          case FieldType::tag:
            add(set->tag(field->spec()).data(), n * sizeof(std::int32_t));
            break;
          case FieldType::identity:
            add(set->ids().data(), n * sizeof(Id));
            break;
        }
      }
    add(&world.clock.time, sizeof(double));
    return sum;
  }

 private:
  int threads_before_ = threads();
};

/// The particle at the place, to a tenth of the spacing; -1 when there is none.
template <int Dim>
Index particle_at(const ParticleSet<Dim>& set, const Vec<Dim>& at) {
  const auto& x = set.vector(fields::position);
  for (Index i = 0; i < set.size(); ++i)
    if ((x[i] - at).norm() < 0.1 * set.spacing()) return i;
  return -1;
}

/// Distance of a point inside the box to the nearest of its faces.
template <int Dim>
double depth_in_box(const Vec<Dim>& x, const Vec<Dim>& lo, const Vec<Dim>& hi) {
  return std::min((x - lo).minCoeff(), (hi - x).minCoeff());
}

}  // namespace sphgeo::test
