#include "core/parallel.h"
#include "effects/interface.h"

namespace sphgeo {
namespace {

/// Transfers the forces of water and soil from the interface to the solids, where they act through
/// all steps of solids in the acoustic step.
template <int Dim>
class SolidLoad final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_load", Stage::force, "Eq. 65, F^rs",
            "transfers the forces of water and soil on their surface to the solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    const bool water = world.find("water"),
               soil = world.find("soil") && world.parameters().soil.deformable;
    if (!world.find("interface") || (!water && !soil)) return {"no solid is in water or soil"};
    return {std::make_unique<SolidLoad>(solid_sets(world), water, soil),
            "there are solids in water or soil"};
  }

  SolidLoad(std::vector<std::string> solids, bool water, bool soil)
      : solids_(std::move(solids)), water_(water), soil_(soil) {}

  std::string acts_on() const override { return "solids"; }
  Needs needs() const override {
    Needs n;
    if (water_) n.fields.push_back({"interface", &fields::water_force, Access::read});
    if (soil_) n.fields.push_back({"interface", &fields::soil_force, Access::read});
    for (const std::string& set : solids_)
      n.fields.push_back({set, &fields::fluid_force, Access::write});
    return n;
  }
  void apply(World<Dim>& world) override {
    map_.update(world);
    std::vector<Field<Vec<Dim>>*> force;
    for (const std::string& set : solids_) {
      force.push_back(&world.set(set).vector(fields::fluid_force));
      parallel_for(force.back()->size(), [&](Index i) { (*force.back())[i].setZero(); });
    }
    ParticleSet<Dim>& interface = world.set("interface");
    const auto& number = interface.tag(fields::source_set);
    const auto add = [&](const FieldSpec& field) {
      const auto& by = interface.vector(field);
      parallel_for(interface.size(), [&](Index s) {
        (*force[static_cast<std::size_t>(number[s])])[map_.at(s).i] += by[s];
      });
    };
    if (water_) add(fields::water_force);
    if (soil_) add(fields::soil_force);
  }
  std::size_t bytes() const override { return map_.bytes(); }

 private:
  std::vector<std::string> solids_;
  bool water_, soil_;
  InterfaceMap<Dim> map_;
};

const RegisterEffect<SolidLoad> registered_solid_load;

}  // namespace
}  // namespace sphgeo
