#include "effects/effect.h"
#include "effects/water_pull.h"

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
    return {{{"water", &fields::pressure, Access::read},
             {"water", &fields::volume, Access::read},
             {"water", &fields::acceleration, Access::read},
             {"water", &fields::density, Access::read},
             {"walls", &fields::wall_force, Access::write}},
            {{"walls", "water"}, {"water", "walls"}}};
  }
  void prepare(World<Dim>& world) override {
    walls_ = &world.set("walls");
    water_ = &world.set("water");
    world.records("water", 1);
  }

  void apply(World<Dim>& world) override {
    const WaterForceOnWall<Dim> pair{
        WallPair<Dim>(world.parameters().water, water_->smoothing_length(), water_->spacing())};
    auto& force = walls_->vector(fields::wall_force);
    parallel_for(walls_->size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& second = world.records("water", 1).template get<T>();
      const Field<double>* scale = gradient_scale(world);
      pack_water_pull(world, world.list("water", "walls"), second);
      parallel_for(water_->size(), [&](Index i) {
        second[i][pair.scale - record_size] =
            static_cast<T>(scale ? (*scale)[i] * (*scale)[i] : 1.0);
      });
      gather<WaterForceOnWall<Dim>::template Sums>(
          world.list("walls", "water"),
          with(world.records("walls", 0).template get<T>(),
               world.records("walls", 1).template get<T>()),
          with(world.records("water", 0).template get<T>(), second), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }

 private:
  ParticleSet<Dim>* walls_ = nullptr;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WallReaction> registered_wall_reaction;

}  // namespace
}  // namespace sphgeo
