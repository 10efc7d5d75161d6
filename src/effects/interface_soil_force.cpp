#include "effects/interface.h"
#include "effects/soil_wall_pair.h"

namespace sphgeo {
namespace {

/// Force of soil on solids: the reaction to what soil_wall_force does, by the same pair function at
/// the same moment.
template <int Dim>
class InterfaceSoilForce final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"interface_soil_force", Stage::force, "Eqs. 70, 90, 95", "force of soil on solids",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface") || !world.find("soil"))
      return {"there are no solids, or there is no soil"};
    if (!world.parameters().soil.deformable) return {"no skeleton is deformable"};
    return {std::make_unique<InterfaceSoilForce>(), "there are solids and soil"};
  }

  std::string acts_on() const override { return "solids near soil"; }
  Needs needs() const override {
    Needs n{{{"interface", &fields::soil_force, Access::write}},
            {{"interface", "soil"}, {"soil", "interface"}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, true);
    need_wall_records<Dim>(n, "interface");
    return n;
  }

  void apply(World<Dim>& world) override {
    const SoilForceOnWall<Dim> pair{SoilWallPair<Dim>(world, world.set("soil"))};
    auto& force = world.set("interface").vector(fields::soil_force);
    parallel_for(force.size(), [&](Index i) { force[i].setZero(); });
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      gather<SoilForceOnWall<Dim>::template Sums>(
          world.list("interface", "soil"), wall_records<T>(world, "interface"),
          soil_records<T, true>(world), pair,
          [&](Index i, const auto& sum) { force[i] = to_vec(sum.force); });
    });
  }
};

const RegisterEffect<InterfaceSoilForce> registered_interface_soil_force;

}  // namespace
}  // namespace sphgeo
