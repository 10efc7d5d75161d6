#include "core/parallel.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Mean over the advection step of the pressure of each water particle, for probes (see MeanForce).
template <int Dim>
class MeanPressure final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"mean_pressure", Stage::force, "-", "mean over the advection step of the pressure",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<MeanPressure>(), "there is water"};
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    return {{{"water", &fields::pressure, Access::read},
             {"water", &fields::mean_pressure, Access::write}},
            {}};
  }
  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& water = world.set("water");
    const double share = world.clock.share_of_mean();
    const auto& p = water.scalar(fields::pressure);
    auto& mean = water.scalar(fields::mean_pressure);
    parallel_for(water.size(), [&](Index i) { mean[i] += share * (p[i] - mean[i]); });
  }
};

const RegisterEffect<MeanPressure> registered_mean_pressure;

}  // namespace
}  // namespace sphgeo
