#include "effects/interface.h"
#include "effects/water_wall_force.h"

namespace sphgeo {
namespace {

/// Force of water on solids: the reaction to what water_wall_force does, by the same pair function
/// at the same moment.
template <int Dim>
class InterfaceWaterForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"interface_water_force", Stage::force, "Eqs. 75-77, 95",
            "pressure and friction of water on solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface") || !world.find("water"))
      return {"there are no solids, or there is no water"};
    return {std::make_unique<InterfaceWaterForce>(), "there are solids and water"};
  }

  std::string acts_on() const override { return "solids near water"; }
  Needs needs() const override {
    Needs n{{{"interface", &fields::water_force, Access::write}},
            {{"interface", "water"}, {"water", "interface"}}};
    need_pressure_gradient<Dim>(n);
    n.record<Position<Dim>>("water", Access::read);
    n.record<packed::WaterState<Dim>>("water", Access::read);
    need_wall_records<Dim>(n, "interface");
    return n;
  }

  void apply(World<Dim>& world) override {
    const ParticleSet<Dim>& water = world.set("water");
    using Gradient = packed::PressureGradient<Dim>;
    using Pair = WaterForceOnWall<Dim, packed::WaterState>;
    const Pair pair{
        WallPair<Dim>(world.parameters().water, water.smoothing_length(), water.spacing())};
    auto& force = world.set("interface").vector(fields::water_force);
    const Field<double>* scale = gradient_scale(world);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    const NeighborList& around = world.list("water", "interface");
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto gradient = write_records<Gradient, T>(world, "water");
      pack_pressure_gradient(world, around, gradient);
      // The volume in the records bears this factor once already.
      for (const auto& block : around.blocks())
        for (const std::uint32_t i : block.targets)
          gradient[i].put(Gradient::reaction_scale, scale ? (*scale)[i] : 1.0);
      gather<Pair::template Sums>(
          world.list("interface", "water"), wall_records<T>(world, "interface"),
          with<T>(read_records<packed::WaterState<Dim>, T>(world, "water"), gradient), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }
};

const RegisterEffect<InterfaceWaterForce> registered_interface_water_force;

}  // namespace
}  // namespace sphgeo
