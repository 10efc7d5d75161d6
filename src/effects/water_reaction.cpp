#include "effects/effect.h"
#include "effects/wall_sets.h"
#include "effects/water_wall_force.h"

namespace sphgeo {
namespace {

/// Force of water on the particles of walls and of the interface of solids: the reaction to what
/// water_wall_force does, by the same pair function at the same moment. Solids move by it; on walls
/// it is summed only where a probe asks.
template <int Dim>
class WaterReaction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_reaction", Stage::force, "Eqs. 75-77, 95",
            "pressure and friction of water on walls and solids", true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_walls<WaterReaction>(world, "water");
  }

  WaterReaction(const World<Dim>&, std::string walls) : walls_(std::move(walls)) {}

  std::string acts_on() const override {
    return (walls_ == "interface" ? "solids" : walls_) + " near water";
  }
  Needs needs() const override {
    Needs n{{{walls_, &fields::water_force, Access::write}},
            {{walls_, "water"}, {"water", walls_}}};
    need_pressure_gradient<Dim>(n);
    n.record<Position<Dim>>("water", Access::read);
    n.record<packed::WaterState<Dim>>("water", Access::read);
    need_wall_records<Dim>(n, walls_);
    return n;
  }

  void apply(World<Dim>& world) override {
    const ParticleSet<Dim>& water = world.set("water");
    using Gradient = packed::PressureGradient<Dim>;
    using Pair = WaterForceOnWall<Dim>;
    const Pair pair{
        WallPair<Dim>(world.parameters().water, water.smoothing_length(), water.spacing())};
    auto& force = world.set(walls_).vector(fields::water_force);
    const Field<double>* scale = gradient_scale(world);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    const NeighborList& around = world.list("water", walls_);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto gradient = write_records<Gradient, T>(world, "water");
      pack_pressure_gradient(world, around, gradient);
      // The volume in the records bears this factor once already.
      for (const auto& block : around.blocks())
        for (const std::uint32_t i : block.targets)
          gradient[i].put(Gradient::reaction_scale, scale ? (*scale)[i] : 1.0);
      gather<Pair::template Sums>(
          world.list(walls_, "water"), wall_records<T>(world, walls_),
          with<T>(read_records<packed::WaterState<Dim>, T>(world, "water"), gradient), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }

 private:
  std::string walls_;
};

const RegisterEffect<WaterReaction> registered_water_reaction;

}  // namespace
}  // namespace sphgeo
