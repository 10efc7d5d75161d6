#include "effects/skin.h"
#include "effects/soil_wall_pair.h"

namespace sphgeo {
namespace {

/// Force of soil on solids: the reaction to what soil_wall_force does, by the same pair function at
/// the same moment.
template <int Dim>
class SkinSoilForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"skin_soil_force", Stage::force, "Eqs. 70, 90, 95", "force of soil on solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("skin") || !world.find("soil"))
      return {"there are no solids, or there is no soil"};
    if (!world.parameters().soil.deformable) return {"no skeleton is deformable"};
    return {std::make_unique<SkinSoilForce>(), "there are solids and soil"};
  }

  std::string acts_on() const override { return "solids near soil"; }
  Needs needs() const override {
    Needs n{{{"skin", &fields::soil_force, Access::write}}, {{"skin", "soil"}, {"soil", "skin"}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, true);
    need_wall_records<Dim>(n, "skin");
    return n;
  }

  void apply(World<Dim>& world) override {
    const SoilForceOnWall<Dim> pair{SoilWallPair<Dim>(world, world.set("soil"))};
    auto& force = world.set("skin").vector(fields::soil_force);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<SoilForceOnWall<Dim>::template Sums>(
          world.list("skin", "soil"), wall_records<T>(world, "skin"), soil_records<T, true>(world),
          pair, [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }
};

const RegisterEffect<SkinSoilForce> registered_skin_soil_force;

}  // namespace
}  // namespace sphgeo
