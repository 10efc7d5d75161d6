#include "effects/effect.h"
#include "effects/water_wall_force.h"

namespace sphgeo {
namespace {

/// Force of the water on every wall particle (Eqs. 76, 77).
template <int Dim>
class WallReaction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_reaction", Stage::observe, "Eqs. 76, 77", "force of the water on wall particles",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water") || !world.find("walls"))
      return {"there is no water, or there are no walls"};
    return {std::make_unique<WallReaction>(), "there are water and walls"};
  }

  std::string acts_on() const override { return "walls near water"; }
  Needs needs() const override {
    Needs n{{{"walls", &fields::wall_force, Access::write}},
            {{"walls", "water"}, {"water", "walls"}}};
    need_pressure_gradient<Dim>(n);
    n.record<Position<Dim>>("water", Access::read);
    n.record<Water>("water", Access::read, Water::velocity, Water::pressure);
    n.record<packed::ObservedWater<Dim>>("water", Access::read);
    need_wall_records<Dim>(n, "walls");
    return n;
  }
  void prepare(World<Dim>& world) override {
    walls_ = &world.set("walls");
    water_ = &world.set("water");
  }

  void apply(World<Dim>& world) override {
    const Pair pair{
        WallPair<Dim>(world.parameters().water, water_->smoothing_length(), water_->spacing())};
    auto& force = walls_->vector(fields::wall_force);
    parallel_for(walls_->size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto gradient = write_records<Gradient, T>(world, "water");
      const Field<double>* scale = gradient_scale(world);
      pack_pressure_gradient(world, world.list("water", "walls"), gradient);
      parallel_for(water_->size(), [&](Index i) {
        gradient[i].put(Gradient::reaction_scale, scale ? (*scale)[i] * (*scale)[i] : 1.0);
      });
      gather<Pair::template Sums>(
          world.list("walls", "water"), wall_records<T>(world, "walls"),
          with<T>(read_records<packed::ObservedWater<Dim>, T>(world, "water"), gradient), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }

 private:
  using Water = packed::WaterState<Dim>;
  using Gradient = packed::PressureGradient<Dim>;
  using Pair = WaterForceOnWall<Dim, packed::ObservedWater>;

  ParticleSet<Dim>* walls_ = nullptr;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WallReaction> registered_wall_reaction;

}  // namespace
}  // namespace sphgeo
