#include "core/parallel.h"
#include "effects/effect.h"

namespace sphgeo {
namespace {

/// Volume fraction at the end of the acoustic step (Eq. 98).
template <int Dim>
class SoilCorrect final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_correct", Stage::correct, "Eq. 98",
            "volume fraction of soil at the end of the step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    return {std::make_unique<SoilCorrect>(), "there is soil"};
  }

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    return {{{"soil", &fields::volume_fraction, Access::update},
             {"soil", &fields::volume_fraction_rate, Access::read}},
            {}};
  }
  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }
  void apply(World<Dim>& world) override {
    const double half = 0.5 * world.clock.dt_acoustic;
    auto& n = soil_->scalar(fields::volume_fraction);
    const auto& rate = soil_->scalar(fields::volume_fraction_rate);
    parallel_for(soil_->size(), [&](Index i) { n[i] += half * rate[i]; });
  }

 private:
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilCorrect> registered_soil_correct;

}  // namespace
}  // namespace sphgeo
