#include "effects/effect.h"
#include "effects/pore_water.h"

namespace sphgeo {
namespace {

/// Mean of a number of the water around, and the weights' sum.
template <int Dim>
struct WaterMean {
  using Water = packed::WaterState<Dim>;
  using Observed = packed::ObservedWater<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T weight{}, pressure{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Position<Dim>>&, const Record<T, Observed>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    const T w = kernel.w(r2) * j[Observed::volume];
    sum.weight += w;
    sum.pressure += w * j[Water::pressure];
  }
};

/// Pore pressure at the soil (Eq. 47), for observers: the force on the soil does not need
/// it (see PorePressure).
template <int Dim>
class SoilPorePressure final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_pore_pressure", Stage::observe, "Eq. 47",
            "pressure of the water at soil particles at the time of a probe or frame", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    return {std::make_unique<SoilPorePressure>(), "there are water and soil"};
  }

  std::string acts_on() const override { return "soil near water"; }
  Needs needs() const override {
    using Water = packed::WaterState<Dim>;
    Needs n{{{"soil", &fields::pore_pressure, Access::write}}, {{"soil", "water"}}};
    n.record<Position<Dim>>("water", Access::read);
    n.record<Water>("water", Access::read, Water::pressure);
    n.record<packed::ObservedWater<Dim>>("water", Access::read);
    n.record<Position<Dim>>("soil", Access::read);
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    auto& p = soil_->scalar(fields::pore_pressure);
    parallel_for(soil_->size(), [&](Index k) { p[k] = 0; });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<WaterMean<Dim>::template Sums>(
          world.list("soil", "water"), read_records<Position<Dim>, T>(world, "soil"),
          read_records<packed::ObservedWater<Dim>, T>(world, "water"),
          WaterMean<Dim>{Kernel<Dim>(water_->smoothing_length())}, [&](Index k, const auto& s) {
            if (s.weight > 0) p[k] = s.pressure / s.weight;
          });
    });
  }

 private:
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilPorePressure> registered_soil_pore_pressure;

}  // namespace
}  // namespace sphgeo
