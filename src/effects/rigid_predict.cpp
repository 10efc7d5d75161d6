#include "core/parallel.h"
#include "effects/rigid_body.h"

namespace sphgeo {
namespace {

/// Rigid solids at the middle of their step, as Eq. 99 does with elastic ones.
template <int Dim>
class RigidPredict final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"rigid_predict", Stage::solid_predict, "Eq. 99",
            "positions of rigid solids at the middle of their step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    return bind_solids<RigidPredict>(world, true);
  }

  explicit RigidPredict(std::string set) : bodies_(std::move(set)) {}
  const std::string& set_name() const { return bodies_.set_name(); }

  std::string acts_on() const override { return set_name(); }
  Needs needs() const override {
    return {{{set_name(), &fields::mass, Access::read},
             {set_name(), &fields::position, Access::update},
             {set_name(), &fields::velocity, Access::update}},
            {}};
  }
  void apply(World<Dim>& world) override {
    bodies_.find(world);
    ParticleSet<Dim>& set = world.set(set_name());
    parallel_blocks(static_cast<Index>(bodies_.size()), 1, [&](Index b, Index, Index) {
      const auto body = static_cast<std::size_t>(b);
      const RigidMotion m = bodies_.motion(world, body);
      bodies_.advance(set, bodies_.particles(body), m, 0.5 * world.clock.dt_solid);
    });
  }
  std::size_t bytes() const override { return bodies_.bytes(); }

 private:
  RigidBodies<Dim> bodies_;
};

const RegisterEffect<RigidPredict> registered_rigid_predict;

}  // namespace
}  // namespace sphgeo
