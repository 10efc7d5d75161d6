#include "core/parallel.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Displacement since t = 0 of soil and solids, for observers. Solids know where they were; of soil
/// it is kept only where this field is asked for.
template <int Dim>
class Displacement final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"displacement", Stage::observe, "-", "displacement of soil and solids since t = 0",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    Binding<Dim> binding("there is no soil and no solid");
    std::vector<std::string> sets = solid_sets(world);
    if (world.find("soil")) sets.emplace_back("soil");
    for (const std::string& set : sets) {
      binding.effects.push_back(std::make_unique<Displacement>(set));
      binding.because = "there is soil, or there are solids";
    }
    return binding;
  }

  explicit Displacement(std::string set) : set_(std::move(set)) {}

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    return {{{set_, &fields::position, Access::read},
             {set_, &fields::reference_position, Access::read},
             {set_, &fields::displacement, Access::write}},
            {}};
  }
  void prepare(World<Dim>& world) override {
    // A run that goes on takes it from its checkpoint.
    if (set_ != "soil") return;
    const ParticleSet<Dim>& soil = world.set(set_);
    auto& start = world.set(set_).vector(fields::reference_position);
    const auto& x = soil.vector(fields::position);
    parallel_for(soil.size(), [&](Index i) { start[i] = x[i]; });
  }
  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    const auto& x = set.vector(fields::position);
    const auto& start = set.vector(fields::reference_position);
    auto& u = set.vector(fields::displacement);
    parallel_for(set.size(), [&](Index i) { u[i] = x[i] - start[i]; });
  }

 private:
  std::string set_;
};

const RegisterEffect<Displacement> registered_displacement;

}  // namespace
}  // namespace sphgeo
