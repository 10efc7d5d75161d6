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
    return {std::make_unique<SoilState>(soil_parameters_used(world)), "there is soil"};
  }

  explicit SoilState(bool parameters) : parameters_(parameters) {}

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::volume_fraction, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::stress, Access::read},
             {"soil", &fields::gradient_correction, Access::read},
             {"soil", &fields::velocity, Access::read},
             {"soil", &fields::pressure, Access::write},
             {"soil", &fields::volume, Access::write}},
            {}};
    need_soil_packing<Dim>(n, parameters_);
    return n;
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
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const SoilPacking<Dim, T> pack(world, *soil_);
      parallel_for(soil_->size(), [&](Index i) {
        p[i] = -stress[i].template head<3>().sum() / 3;
        volume[i] = m[i] / (n[i] * parts[part[i]].grain_density);
        // Pair sums of the observation, such as the force on a wall, read the records.
        pack(i);
      });
    });
  }

 private:
  bool parameters_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilState> registered_soil_state;

}  // namespace
}  // namespace sphgeo
