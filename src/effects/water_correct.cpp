#include "core/parallel.h"
#include "effects/effect.h"

namespace sphgeo {
namespace {

/// Density at the end of the acoustic step (Eq. 98).
template <int Dim>
class WaterCorrect final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_correct", Stage::correct, "Eq. 98", "density at the end of the step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterCorrect>(), "there is water"};
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    return {{{"water", &fields::density, Access::update},
             {"water", &fields::density_rate, Access::read}},
            {}};
  }
  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }
  void apply(World<Dim>& world) override {
    const double half = 0.5 * world.clock.dt_acoustic;
    auto& rho = water_->scalar(fields::density);
    const auto& rate = water_->scalar(fields::density_rate);
    parallel_for(water_->size(), [&](Index i) { rho[i] += half * rate[i]; });
  }

 private:
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterCorrect> registered_water_correct;

}  // namespace
}  // namespace sphgeo
