#include "core/parallel.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Mean over the advection step of what the acoustic steps did, for probes. The value at the end of
/// the step, after particles are arranged and their density is summed anew, is not what moved
/// anything: on a cylinder towed through water these values add up to an impulse with the wrong
/// sign. The pressure of the water itself differs by some pascals only (share/doc/probes.md).
template <int Dim>
class MeanForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"mean_force", Stage::force, "-",
            "mean over the advection step of the forces on walls and solids", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    Binding<Dim> binding("no wall and no solid is in water or soil");
    for (const std::string& set : wall_sets(world))
      for (const Source& source : sources)
        if (world.find(source.phase) &&
            (source.force == &fields::water_force || world.parameters().soil.deformable)) {
          binding.effects.push_back(std::make_unique<MeanForce>(set, source));
          binding.because = "walls or solids are in water or soil";
        }
    return binding;
  }

  struct Source {
    const char* phase;
    const FieldSpec *force, *mean;
  };
  static constexpr Source sources[] = {{"water", &fields::water_force, &fields::mean_water_force},
                                       {"soil", &fields::soil_force, &fields::mean_soil_force}};

  MeanForce(std::string set, const Source& source) : set_(std::move(set)), source_(source) {}

  std::string acts_on() const override {
    return std::string(source_.phase) + " on " + (set_ == "interface" ? "solids" : set_);
  }
  Needs needs() const override {
    return {{{set_, source_.force, Access::read}, {set_, source_.mean, Access::write}}, {}};
  }
  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    const double share = world.clock.share_of_mean();
    const auto& force = set.vector(*source_.force);
    auto& mean = set.vector(*source_.mean);
    parallel_for(set.size(), [&](Index i) { mean[i] += share * (force[i] - mean[i]); });
  }

 private:
  std::string set_;
  Source source_;
};

const RegisterEffect<MeanForce> registered_mean_force;

}  // namespace
}  // namespace sphgeo
