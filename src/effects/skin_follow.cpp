#include "core/parallel.h"
#include "effects/skin.h"
#include "effects/wall_records.h"

namespace sphgeo {
namespace {

/// Takes the skin where its solids are, with velocity and acceleration averaged over their steps (Eq. 95).
template <int Dim>
class SkinFollow final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"skin_follow", Stage::solid_finish, "Eq. 95", "place, mean velocity and mean acceleration of the surface of solids", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("skin")) return {"no solid can meet anything"};
    return {std::make_unique<SkinFollow>(world), "solids can meet something"};
  }

  explicit SkinFollow(const World<Dim>& world) : solids_(solid_sets(world)), seen_(world.find("water") || world.find("soil")) {}

  std::string acts_on() const override { return "skin"; }
  Needs needs() const override {
    Needs n{{{"skin", &fields::position, Access::update}, {"skin", &fields::velocity, Access::update}, {"skin", &fields::acceleration, Access::update}}, {}};
    for (const std::string& set : solids_)
      for (const FieldSpec* f : {&fields::position, &fields::mean_velocity, &fields::acceleration}) n.fields.push_back({set, f, Access::read});
    return n;
  }

  void apply(World<Dim>& world) override {
    map_.update(world);
    ParticleSet<Dim>& skin = world.set("skin");
    auto& x = skin.vector(fields::position);
    auto& v = skin.vector(fields::velocity);
    auto& a = skin.vector(fields::acceleration);
    parallel_for(skin.size(), [&](Index k) {
      const auto& [of, i] = map_.at(k);
      x[k] = of->position[i];
      v[k] = of->mean_velocity[i];
      a[k] = of->acceleration[i];
    });
    if (!seen_) return;
    pack_walls(world, "skin");
    if (!world.frozen_geometry()) world.pack_positions(skin);
  }
  std::size_t bytes() const override { return map_.bytes(); }

 private:
  std::vector<std::string> solids_;
  bool seen_;  // by water or soil
  SkinMap<Dim> map_;
};

const RegisterEffect<SkinFollow> registered;

}  // namespace
}  // namespace sphgeo
