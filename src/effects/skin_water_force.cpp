#include "effects/skin.h"
#include "effects/water_pull.h"

namespace sphgeo {
namespace {

/// Force of water on solids: the reaction to what water_wall_force does, by the same pair function
/// at the same moment.
template <int Dim>
class SkinWaterForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"skin_water_force", Stage::force, "Eqs. 75-77, 95",
            "pressure and friction of water on solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("skin") || !world.find("water"))
      return {"there are no solids, or there is no water"};
    return {std::make_unique<SkinWaterForce>(), "there are solids and water"};
  }

  std::string acts_on() const override { return "solids near water"; }
  Needs needs() const override {
    return {{{"water", &fields::pressure, Access::read},
             {"water", &fields::acceleration, Access::read},
             {"water", &fields::density, Access::read},
             {"skin", &fields::volume, Access::read},
             {"skin", &fields::water_force, Access::write}},
            {{"skin", "water"}, {"water", "skin"}}};
  }
  void prepare(World<Dim>& world) override { world.records("water", 1); }

  void apply(World<Dim>& world) override {
    const ParticleSet<Dim>& water = world.set("water");
    const WaterForceOnWall<Dim> pair{
        WallPair<Dim>(world.parameters().water, water.smoothing_length(), water.spacing())};
    auto& force = world.set("skin").vector(fields::water_force);
    const Field<double>* scale = gradient_scale(world);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    const NeighborList& around = world.list("water", "skin");
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& second = world.records("water", 1).template get<T>();
      pack_water_pull(world, around, second);
      // The volume in the records bears this factor once already.
      for (const auto& block : around.blocks())
        for (const std::uint32_t i : block.targets)
          second[i][pair.scale - record_size] = static_cast<T>(scale ? (*scale)[i] : 1.0);
      gather<WaterForceOnWall<Dim>::template Sums>(
          world.list("skin", "water"),
          with(world.records("skin", 0).template get<T>(),
               world.records("skin", 1).template get<T>()),
          with(world.records("water", 0).template get<T>(), second), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }
};

const RegisterEffect<SkinWaterForce> registered_skin_water_force;

}  // namespace
}  // namespace sphgeo
