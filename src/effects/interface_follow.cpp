#include "core/parallel.h"
#include "effects/interface.h"
#include "effects/pack_walls.h"

namespace sphgeo {
namespace {

/// Takes the interface where its solids are at the end of the acoustic step.
///
/// Eq. 95 gives water and soil the velocity averaged over the steps of the solids. Their own
/// density follows from velocities at both ends of the step (Eqs. 96 to 98); with an average beside
/// them the surface is half a step late, and what is lighter than the water around it is thrown
/// about by that (see light_solids.h).
template <int Dim>
class InterfaceFollow final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"interface_follow", Stage::solid_finish, "Eq. 95",
            "position and velocity of the surface of solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("interface")) return {"no solid can meet anything"};
    return {std::make_unique<InterfaceFollow>(world), "solids can meet something"};
  }

  explicit InterfaceFollow(const World<Dim>& world)
      : solids_(solid_sets(world)),
        seen_(world.find("water") || world.find("soil")),
        current_geometry_(!world.frozen_geometry()) {}

  std::string acts_on() const override { return "interface"; }
  Needs needs() const override {
    Needs n{{{"interface", &fields::position, Access::update},
             {"interface", &fields::velocity, Access::update}},
            {}};
    for (const std::string& set : solids_)
      for (const FieldSpec* f : {&fields::position, &fields::velocity})
        n.fields.push_back({set, f, Access::read});
    if (!seen_) return n;
    need_wall_packing<Dim>(n, "interface", Access::write);
    if (current_geometry_) n.record<Position<Dim>>("interface", Access::update);
    return n;
  }

  void apply(World<Dim>& world) override {
    map_.update(world);
    ParticleSet<Dim>& interface = world.set("interface");
    auto& x = interface.vector(fields::position);
    auto& v = interface.vector(fields::velocity);
    parallel_for(interface.size(), [&](Index k) {
      const auto& [of, i] = map_.at(k);
      x[k] = of->position[i];
      v[k] = of->velocity[i];
    });
    if (!seen_) return;
    pack_walls(world, "interface");
    if (current_geometry_) world.pack_positions(interface);
  }
  std::size_t bytes() const override { return map_.bytes(); }

 private:
  std::vector<std::string> solids_;
  bool seen_;  // by water or soil
  bool current_geometry_;
  InterfaceMap<Dim> map_;
};

const RegisterEffect<InterfaceFollow> registered_interface_follow;

}  // namespace
}  // namespace sphgeo
