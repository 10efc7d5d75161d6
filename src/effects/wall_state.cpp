#include "effects/effect.h"
#include "effects/wall_records.h"

namespace sphgeo {
namespace {

/// Gets the walls ready for pair sums after a rearrangement.
template <int Dim>
class WallState final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_state", Stage::reinitialize, "Eq. 73", "packs volume, normal and push of the walls", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("walls")) return {"there are no walls"};
    return {std::make_unique<WallState>(), "there are walls"};
  }

  std::string acts_on() const override { return "walls"; }
  Needs needs() const override {
    return {{{"walls", &fields::volume, Access::write},
             {"walls", &fields::velocity, Access::read},
             {"walls", &fields::acceleration, Access::read},
             {"walls", &fields::normal, Access::read},
             {"walls", &fields::no_slip, Access::read}},
            {}};
  }
  void prepare(World<Dim>& world) override {
    world.records("walls", 0);
    world.records("walls", 1);
  }
  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& walls = world.set("walls");
    auto& volume = walls.scalar(fields::volume);
    for (Index i = 0; i < walls.size(); ++i) volume[i] = std::pow(walls.spacing(), Dim);
    pack_walls(world);
  }
};

const RegisterEffect<WallState> registered;

}  // namespace
}  // namespace sphgeo
