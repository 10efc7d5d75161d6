#include "effects/effect.h"
#include "effects/soil_wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Force of soil on the particles of walls and of the interface of solids: the reaction to what
/// soil_wall_force does, by the same pair function at the same moment. Solids move by it; on walls
/// it is summed only where a probe asks.
template <int Dim>
class SoilReaction final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_reaction", Stage::force, "Eqs. 70, 90, 95", "force of soil on walls and solids",
            true};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (world.find("soil") && !world.parameters().soil.deformable)
      return {"no skeleton is deformable"};
    return bind_walls<SoilReaction>(world, "soil");
  }

  SoilReaction(const World<Dim>&, std::string walls) : walls_(std::move(walls)) {}

  std::string acts_on() const override {
    return (walls_ == "interface" ? "solids" : walls_) + " near soil";
  }
  Needs needs() const override {
    Needs n{{{walls_, &fields::soil_force, Access::write}}, {{walls_, "soil"}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, true);
    need_wall_records<Dim>(n, walls_);
    return n;
  }

  void apply(World<Dim>& world) override {
    const SoilForceOnWall<Dim> pair{SoilWallPair<Dim>(world, world.set("soil"))};
    auto& force = world.set(walls_).vector(fields::soil_force);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<SoilForceOnWall<Dim>::template Sums>(
          world.list(walls_, "soil"), wall_records<T>(world, walls_), soil_records<T, true>(world),
          pair, [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }

 private:
  std::string walls_;
};

const RegisterEffect<SoilReaction> registered_soil_reaction;

}  // namespace
}  // namespace sphgeo
