#include "core/parallel.h"
#include "effects/skin.h"

namespace sphgeo {
namespace {

/// Hands the forces of water and soil from the skin to the solids, where they act through all steps of solids in the
/// acoustic step.
template <int Dim>
class SolidLoad final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"solid_load", Stage::force, "Eq. 65, F^rs", "hands the forces of water and soil on their surface to the solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    const bool water = world.find("water"), soil = world.find("soil") && SoilParts(world).deformable;
    if (!world.find("skin") || (!water && !soil)) return {"no solid is in water or soil"};
    return {std::make_unique<SolidLoad>(solid_sets(world), water, soil), "there are solids in water or soil"};
  }

  SolidLoad(std::vector<std::string> solids, bool water, bool soil) : solids_(std::move(solids)), water_(water), soil_(soil) {}

  std::string acts_on() const override { return "solids"; }
  Needs needs() const override {
    Needs n;
    if (water_) n.fields.push_back({"skin", &fields::water_force, Access::read});
    if (soil_) n.fields.push_back({"skin", &fields::soil_force, Access::read});
    for (const std::string& set : solids_) n.fields.push_back({set, &fields::fluid_force, Access::write});
    return n;
  }
  void apply(World<Dim>& world) override {
    map_.update(world);
    std::vector<Field<Vec<Dim>>*> force;
    for (const std::string& set : solids_) {
      force.push_back(&world.set(set).vector(fields::fluid_force));
      parallel_for(force.back()->size(), [&](Index i) { (*force.back())[i].setZero(); });
    }
    const ParticleSet<Dim>& skin = world.set("skin");
    const auto& number = skin.tag(fields::source_set);
    const auto add = [&](const FieldSpec& field) {
      const auto& by = skin.vector(field);
      parallel_for(skin.size(), [&](Index s) { (*force[static_cast<std::size_t>(number[s])])[map_.at(s).i] += by[s]; });
    };
    if (water_) add(fields::water_force);
    if (soil_) add(fields::soil_force);
  }
  std::size_t bytes() const override { return map_.bytes(); }

 private:
  std::vector<std::string> solids_;
  bool water_, soil_;
  SkinMap<Dim> map_;
};

const RegisterEffect<SolidLoad> registered;

}  // namespace
}  // namespace sphgeo
