#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Pressure and volume of the current state, for observers between two steps.
template <int Dim>
class WaterPressure final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_pressure", Stage::observe, "Eqs. 26, 27",
            "pressure and volume at the time of a probe or frame", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterPressure>(world), "there is water"};
  }

  explicit WaterPressure(const World<Dim>& world) { need_volume_share(world, volume_); }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::density, Access::read},
             {"water", &fields::mass, Access::read},
             {"water", &fields::pressure, Access::write},
             {"water", &fields::volume, Access::write}},
            {}};
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    n.record<Water>("water", Access::write, Water::velocity, Water::pressure);
    n.record<Observed>("water", Access::write);
    return n;
  }
  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }
  void apply(World<Dim>& world) override {
    const WaterParameters& w = world.parameters().water;
    auto& p = water_->scalar(fields::pressure);
    auto& volume = water_->scalar(fields::volume);
    const auto& rho = water_->scalar(fields::density);
    const auto& m = water_->scalar(fields::mass);
    const auto& v = water_->vector(fields::velocity);
    const Field<double>* share = volume_share(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Water, T>(world, "water");
      const auto volumes = write_records<Observed, T>(world, "water");
      parallel_for(water_->size(), [&](Index i) {
        p[i] = w.sound_speed * w.sound_speed * (rho[i] - w.density);
        volume[i] = m[i] / (share ? (*share)[i] * rho[i] : rho[i]);
        // Pair sums of the observation, such as the force on a wall, read the records.
        const auto record = records[i];
        volumes[i].put(Observed::volume, volume[i]);
        record.put(Water::pressure, p[i]);
        record.put(Water::velocity, v[i]);
      });
    });
  }

 private:
  using Water = packed::WaterState<Dim>;
  using Observed = packed::ObservedWater<Dim>;

  Needs volume_;  // what the volume needs beside mass and density
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterPressure> registered_water_pressure;

}  // namespace
}  // namespace sphgeo
