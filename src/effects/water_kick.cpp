#include <cmath>

#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Velocity and place at the end of the acoustic step (Eqs. 97, 98), and the step bounds of the
/// water (Eqs. 91, 92).
template <int Dim>
class WaterKick final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_kick", Stage::kick, "Eqs. 91, 92, 97, 98", "velocity and place at the end of the step; bounds of both clocks", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterKick>(), "there is water"};
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    return {{{"water", &fields::velocity, Access::update},
             {"water", &fields::position, Access::update},
             {"water", &fields::acceleration, Access::write},
             {"water", &fields::acceleration_sum, Access::read}},
            {}};
  }

  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    const double dt = world.clock.dt_acoustic;
    auto& x = water_->vector(fields::position);
    auto& v = water_->vector(fields::velocity);
    auto& a = water_->vector(fields::acceleration);
    const auto& sum = water_->vector(fields::acceleration_sum);
    const bool repack = !world.frozen_geometry();
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& records = world.records("water").template get<T>();
      parallel_for(water_->size(), [&](Index i) {
        a[i] = sum[i];
        v[i] += dt * sum[i];
        x[i] += 0.5 * dt * v[i];
        T* slot = records[i];
        for (int k = 0; k < Dim; ++k) slot[water_slot::velocity + k] = static_cast<T>(v[i][k]);
        if (repack) records.set_position(i, x[i]);
      });
    });
  }

  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const Numerics& n = world.model().numerics;
    const WaterConstants w = WaterConstants::of(world);
    const double h = water_->smoothing_length();
    const auto& v = water_->vector(fields::velocity);
    const double speed = std::sqrt(block_max(water_->size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0));
    limits.note_speed("water", speed / w.sound_speed);
    const double acoustic = n.cfl_acoustic * h / (w.sound_speed + speed);  // Eq. 92
    limits.acoustic = std::min(limits.acoustic, acoustic);
    // Eq. 91. At rest h/|v| has no bound: then the acoustic step bounds it, by a ratio that equals
    // what Eqs. 91 and 92 give together at a tenth of the speed of sound.
    double advection = std::min(n.advection_ratio_max * acoustic, n.cfl_advection * h / std::max(speed, 1e-300));
    if (w.viscosity > 0) advection = std::min(advection, n.cfl_advection * w.density * h * h / w.viscosity);
    limits.advection = std::min(limits.advection, advection);
  }

 private:
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterKick> registered;

}  // namespace
}  // namespace sphgeo
