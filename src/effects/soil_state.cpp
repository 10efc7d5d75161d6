#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/soil_phase.h"

namespace sphgeo {
namespace {

/// Mean pressure and volume of the current state, for observers between two steps.
template <int Dim>
class SoilState final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_state", Stage::observe, "Eqs. 1, 52",
            "mean effective pressure and volume of soil at the time of a probe or frame", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    return {std::make_unique<SoilState>(), "there is soil"};
  }

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    return {{{"soil", &fields::volume_fraction, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::stress, Access::read},
             {"soil", &fields::pressure, Access::write},
             {"soil", &fields::volume, Access::write}},
            {}};
  }
  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }
  void apply(World<Dim>& world) override {
    const SoilParameters& parts = world.parameters().soil;
    auto& p = soil_->scalar(fields::pressure);
    auto& volume = soil_->scalar(fields::volume);
    const auto& n = soil_->scalar(fields::volume_fraction);
    const auto& m = soil_->scalar(fields::mass);
    const auto& stress = soil_->tensor(fields::stress);
    const auto& part = soil_->tag(fields::part);
    parallel_for(soil_->size(), [&](Index i) {
      p[i] = -stress[i].template head<3>().sum() / 3;
      volume[i] = m[i] / (n[i] * parts[part[i]].grain_density);
    });
  }

 private:
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilState> registered_soil_state;

}  // namespace
}  // namespace sphgeo
