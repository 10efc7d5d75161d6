#include <algorithm>

#include "effects/effect.h"
#include "sph/parameters.h"

namespace sphgeo {
namespace {

/// The clock of a scene in which nothing moves, such as one that only leads material points along
/// stress paths: as fast as its probes sample.
template <int Dim>
class IdleClock final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"idle_clock", Stage::predict, "", "lets time pass where no particle moves", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    for (const auto& set : world.sets())
      if (set->phase() != "wall") return {"the " + set->name() + " bounds the steps"};
    return {std::make_unique<IdleClock>(), "there is nothing that moves"};
  }

  std::string acts_on() const override { return "time"; }
  Needs needs() const override { return {}; }
  void apply(World<Dim>&) override {}
  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const double step = world.parameters().shortest_interval;
    limits.advection = std::min(limits.advection, step);
    limits.lower_acoustic(step, "probes");
  }
};

const RegisterEffect<IdleClock> registered_idle_clock;

}  // namespace
}  // namespace sphgeo
