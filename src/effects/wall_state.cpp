#include "effects/effect.h"
#include "effects/pack_walls.h"
#include "sph/parameters.h"

namespace sphgeo {
namespace {

/// Gets the walls ready for pair sums after a rearrangement.
template <int Dim>
class WallState final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_state", Stage::reinitialize, "Eq. 73",
            "packs volume, normal and push of the walls", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("walls")) return {"there are no walls"};
    return {std::make_unique<WallState>(world.moves("walls")), "there are walls"};
  }

  explicit WallState(bool moves) : moves_(moves) {}

  std::string acts_on() const override { return "walls"; }
  Needs needs() const override {
    Needs n{{{"walls", &fields::volume, Access::write},
             {"walls", &fields::velocity, Access::read},
             {"walls", &fields::normal, Access::read},
             {"walls", &fields::no_slip, Access::read}},
            {}};
    if (moves_) n.fields.push_back({"walls", &fields::acceleration, Access::read});
    need_wall_packing<Dim>(n, "walls", Access::write);
    return n;
  }
  void apply(World<Dim>& world) override {
    // What rests, under a body acceleration that rests, is packed once.
    if (packed_ && !moves_ && !world.parameters().body_force) return;
    restore(world);
  }
  void restore(World<Dim>& world) override {
    pack_walls(world);
    packed_ = true;
    ParticleSet<Dim>& walls = world.set("walls");
    auto& volume = walls.scalar(fields::volume);
    const double each = std::pow(walls.spacing(), Dim);
    parallel_for(walls.size(), [&](Index i) { volume[i] = each; });
  }

 private:
  bool moves_;
  bool packed_ = false;
};

const RegisterEffect<WallState> registered_wall_state;

}  // namespace
}  // namespace sphgeo
