#include "core/parallel.h"
#include "boundaries/boundary.h"
#include "effects/effect.h"
#include "effects/wall_records.h"

namespace sphgeo {
namespace {

/// The boundary of a wall particle's part, when it moves.
const Motion* motion_of(const Model& model, std::int32_t part) {
  const auto* wall = dynamic_cast<const WallBoundary*>(model.boundaries[static_cast<std::size_t>(part)].get());
  return wall && wall->motion ? &*wall->motion : nullptr;
}

/// Walls whose motion the deck prescribes: place at the end of the step, velocity and acceleration
/// at its middle.
template <int Dim>
class WallMotion final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_motion", Stage::predict, "prescribed", "moves walls as the deck says", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    for (std::size_t k = 0; k < world.model().boundaries.size(); ++k)
      if (world.find("walls") && motion_of(world.model(), static_cast<std::int32_t>(k)))
        return {std::make_unique<WallMotion>(), "boundary '" + world.model().boundaries[k]->name + "' has a motion"};
    return {"no boundary has a motion"};
  }

  std::string acts_on() const override { return "walls"; }
  Needs needs() const override {
    return {{{"walls", &fields::part, Access::read},
             {"walls", &fields::reference_position, Access::read},
             {"walls", &fields::reference_normal, Access::read},
             {"walls", &fields::position, Access::update},
             {"walls", &fields::velocity, Access::update},
             {"walls", &fields::acceleration, Access::update},
             {"walls", &fields::normal, Access::update}},
            {}};
  }

  void prepare(World<Dim>& world) override { walls_ = &world.set("walls"); }

  void apply(World<Dim>& world) override {
    const double end = world.clock.time + world.clock.dt_acoustic;
    const double middle = world.clock.time + 0.5 * world.clock.dt_acoustic;
    const auto& part = walls_->tag(fields::part);
    const auto& x0 = walls_->vector(fields::reference_position);
    const auto& n0 = walls_->vector(fields::reference_normal);
    auto& x = walls_->vector(fields::position);
    auto& v = walls_->vector(fields::velocity);
    auto& a = walls_->vector(fields::acceleration);
    auto& n = walls_->vector(fields::normal);
    parallel_for(walls_->size(), [&](Index i) {
      const Motion* motion = motion_of(world.model(), part[i]);
      if (!motion) return;
      const Vec3 from = to_space<Dim>(x0[i]);
      x[i] = to_scene<Dim>(motion->position(from, end));
      v[i] = to_scene<Dim>(motion->velocity(from, middle));
      a[i] = to_scene<Dim>(motion->acceleration(from, middle));
      n[i] = to_scene<Dim>(motion->direction(to_space<Dim>(n0[i]), end));
    });
    pack_walls(world);
    if (!world.frozen_geometry()) world.pack_positions(*walls_);
  }

 private:
  ParticleSet<Dim>* walls_ = nullptr;
};

const RegisterEffect<WallMotion> registered;

}  // namespace
}  // namespace sphgeo
