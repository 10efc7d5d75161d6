#include "effects/effect.h"
#include "effects/wall_pair.h"

namespace sphgeo {
namespace {

/// The reaction: the same pair function, seen from the wall.
template <int Dim>
struct WaterForceOnWall {
  WallPair<Dim> wall;
  static constexpr int scale = 13;  ///< slot of what gradient_scale() makes of the force, squared

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T, 2>& i, const Record<Dim, T, 2>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.force -= (j[water_slot::volume] * j[scale]) * wall.force(j, i, T(-1) * r, r2);
  }
};

/// Force of the water on every wall particle (Eqs. 76, 77).
template <int Dim>
class WallReaction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_reaction", Stage::observe, "Eqs. 76, 77", "force of the water on wall particles", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water") || !world.find("walls")) return {"there is no water, or there are no walls"};
    return {std::make_unique<WallReaction>(), "there are water and walls"};
  }

  std::string acts_on() const override { return "walls near water"; }
  Needs needs() const override {
    return {{{"water", &fields::pressure, Access::read}, {"water", &fields::volume, Access::read},
             {"water", &fields::acceleration, Access::read}, {"water", &fields::density, Access::read},
             {"walls", &fields::wall_force, Access::write}},
            {{"walls", "water"}}};
  }
  void prepare(World<Dim>& world) override {
    walls_ = &world.set("walls");
    water_ = &world.set("water");
    world.records("water", 1);
  }

  void apply(World<Dim>& world) override {
    const WaterForceOnWall<Dim> pair{WallPair<Dim>(WaterConstants::of(world), water_->smoothing_length(), water_->spacing())};
    auto& force = walls_->vector(fields::wall_force);
    const auto& a = water_->vector(fields::acceleration);
    const auto& rho = water_->scalar(fields::density);
    const auto& x = water_->vector(fields::position);
    parallel_for(walls_->size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& second = world.records("water", 1).template get<T>();
      const Field<double>* scale = gradient_scale(world);
      const Field<Vec<Dim>>* drag = water_->has(fields::drag_acceleration) ? &water_->vector(fields::drag_acceleration) : nullptr;
      parallel_for(water_->size(), [&](Index i) {
        T* slot = second[i] - record_size;
        Vec<Dim> pull = world.pull(x[i]) - a[i];
        if (drag) pull += (*drag)[i];
        for (int k = 0; k < Dim; ++k) slot[water_slot::pull + k] = static_cast<T>(pull[k]);
        slot[water_slot::density] = static_cast<T>(rho[i]);
        slot[pair.scale] = static_cast<T>(scale ? (*scale)[i] * (*scale)[i] : 1.0);
      });
      gather<WaterForceOnWall<Dim>::template Sums>(
          world.list("walls", "water"),
          with(world.records("walls", 0).template get<T>(), world.records("walls", 1).template get<T>()),
          with(world.records("water", 0).template get<T>(), second), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }

 private:
  ParticleSet<Dim>* walls_ = nullptr;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WallReaction> registered;

}  // namespace
}  // namespace sphgeo
