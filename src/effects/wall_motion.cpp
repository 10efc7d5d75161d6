#include <cmath>
#include <optional>
#include <vector>

#include "core/indices_where.h"
#include "core/parallel.h"
#include "deck/motion.h"
#include "effects/effect.h"
#include "effects/pack_walls.h"
#include "sph/parameters.h"

namespace sphgeo {
namespace {

/// Displacement, velocity and acceleration that active wave absorption adds (wave_absorption.cpp):
/// zero for every other wall.
struct Extra {
  Vec3 shift = Vec3::Zero(), velocity = Vec3::Zero(),
       acceleration = Vec3::Zero();  // at the end, the middle and the middle of the step

  Extra() = default;
  /// Brings the piston nearer to the speed that it is to have.
  Extra(PistonState& state, const Vec3& direction, double dt) {
    const double before = state.speed;
    if (state.lag > 0) state.speed += (state.wanted - before) * -std::expm1(-dt / state.lag);
    state.shift += 0.5 * (before + state.speed) * dt;
    shift = state.shift * direction;
    velocity = 0.5 * (before + state.speed) * direction;
    acceleration = (state.speed - before) / dt * direction;
  }
};

/// Walls whose motion the deck prescribes: position at the end of the step, velocity and
/// acceleration at its middle.
template <int Dim>
class WallMotion final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"wall_motion", Stage::predict, "prescribed", "moves walls as the deck says", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    for (const BoundaryMotion& wall : world.parameters().boundary_motions)
      if (world.find("walls") && wall.motion)
        return {std::make_unique<WallMotion>(!world.frozen_geometry()),
                "boundary '" + wall.name + "' has a motion"};
    return {"no boundary has a motion"};
  }

  explicit WallMotion(bool current_geometry) : current_geometry_(current_geometry) {}

  std::string acts_on() const override { return "walls"; }
  Needs needs() const override {
    Needs n{{{"walls", &fields::part, Access::read},
             {"walls", &fields::reference_position, Access::read},
             {"walls", &fields::reference_normal, Access::read},
             {"walls", &fields::position, Access::update},
             {"walls", &fields::velocity, Access::update},
             {"walls", &fields::acceleration, Access::update},
             {"walls", &fields::normal, Access::update}},
            {}};
    need_wall_packing<Dim>(n, "walls", Access::update);
    if (current_geometry_) n.record<Position<Dim>>("walls", Access::update);
    return n;
  }

  void prepare(World<Dim>& world) override {
    walls_ = &world.set("walls");
    for (const BoundaryMotion& wall : world.parameters().boundary_motions)
      motions_.push_back(wall.motion);
  }

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
    find_moving(world);
    std::vector<std::optional<Motion::Moment>> moments(motions_.size());
    std::vector<Extra> extras(motions_.size());
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      if (!motions_[k]) continue;
      moments[k].emplace(*motions_[k], middle, end);
      const BoundaryMotion& wall = world.parameters().boundary_motions[k];
      if (wall.absorbs_waves)
        extras[k] =
            Extra(world.piston(wall.name), motions_[k]->waves->direction, world.clock.dt_acoustic);
    }
    parallel_for(static_cast<Index>(moving_.size()), [&](Index place) {
      const Index i = moving_[static_cast<std::size_t>(place)];
      const auto mover = static_cast<std::size_t>(part[i]);
      const Motion::Moment& motion = *moments[mover];
      const Extra& extra = extras[mover];
      const Vec3 from = to_space<Dim>(x0[i]);
      x[i] = to_scene<Dim>(motion.position(from) + extra.shift);
      v[i] = to_scene<Dim>(motion.velocity(from) + extra.velocity);
      a[i] = to_scene<Dim>(motion.acceleration(from) + extra.acceleration);
      n[i] = to_scene<Dim>(motion.direction(to_space<Dim>(n0[i])));
    });
    pack_walls(world, "walls", &moving_);
    if (!current_geometry_) return;
    world.with_pair_precision([&](auto number) {
      const auto record = write_records<Position<Dim>, decltype(number)>(world, "walls");
      parallel_for(static_cast<Index>(moving_.size()), [&](Index k) {
        const Index i = moving_[static_cast<std::size_t>(k)];
        record.set_position(i, x[i]);
      });
    });
  }
  std::size_t bytes() const override { return moving_.capacity() * sizeof(Index); }

 private:
  /// Walls that rest share the set: those that move are looked up once per arrangement.
  void find_moving(const World<Dim>& world) {
    if (arrangement_ == world.arrangement()) return;
    arrangement_ = world.arrangement();
    const auto& part = walls_->tag(fields::part);
    const auto moving = indices_where(walls_->size(), [&](Index i) {
      return motions_[static_cast<std::size_t>(part[i])] != nullptr;
    });
    moving_.assign(moving.begin(), moving.end());
  }

  bool current_geometry_;
  std::vector<const Motion*> motions_;  ///< by number of the boundary; null: it rests
  std::vector<Index> moving_;
  long arrangement_ = -1;
  ParticleSet<Dim>* walls_ = nullptr;
};

const RegisterEffect<WallMotion> registered_wall_motion;

}  // namespace
}  // namespace sphgeo
