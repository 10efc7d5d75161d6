#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "effects/light_solids.h"
#include "effects/rigid_body.h"

namespace sphgeo {
namespace {

/// Rigid solids at the end of their step: the forces on their particles change the velocity and the
/// angular momentum of each body, which then moves to the end (as Eqs. 100, 101 do with elastic
/// ones).
template <int Dim>
class RigidKick final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {
        "rigid_kick", Stage::solid_kick, "Eqs. 94, 95, 100, 101",
        "velocity, turning and position of rigid solids at the end of their step; bound of their "
        "clock",
        false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<RigidKick>(world, true); }

  explicit RigidKick(std::string set) : bodies_(std::move(set)) {}
  const std::string& set_name() const { return bodies_.set_name(); }

  std::string acts_on() const override { return set_name(); }
  Needs needs() const override {
    return {{{set_name(), &fields::acceleration_sum, Access::read},
             {set_name(), &fields::mass, Access::read},
             {set_name(), &fields::fluid_force, Access::read, true},
             {set_name(), &fields::position, Access::update},
             {set_name(), &fields::velocity, Access::update},
             {set_name(), &fields::acceleration, Access::update}},
            {}};
  }

  void apply(World<Dim>& world) override {
    bodies_.find(world);
    ParticleSet<Dim>& set = world.set(set_name());
    parallel_blocks(static_cast<Index>(bodies_.size()), 1,
                    [&](Index b, Index, Index) { kick(world, set, static_cast<std::size_t>(b)); });
  }

  void prepare(World<Dim>& world) override {
    for (const SolidPart& p : world.parameters().solids.of)
      if (p.rigid() && p.set == set_name())
        sound_ = std::max(sound_, std::sqrt(p.contact_stiffness / p.density));
  }

  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const ParticleSet<Dim>& set = world.set(set_name());
    const NumericsParameters& n = world.parameters().numerics;
    const double h = set.smoothing_length();
    const auto& v = set.vector(fields::velocity);
    const double speed = std::sqrt(block_max(
        set.size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0));
    // No wave runs in it: what its step must resolve is a contact, as stiff as a solid of that
    // speed of sound.
    const double step = n.cfl_solid * h / (sound_ + speed);
    limits.note_speed(set_name(), speed / sound_);
    limits.solid = std::min(limits.solid, step);
    // Not before: a run that is resumed has no particles yet when it is prepared.
    if (!beside_) beside_ = step_beside_light_solids(world, set_name());
    limits.lower_acoustic(*beside_, "a solid lighter than what touches it");
    limits.advection = std::min(limits.advection, n.cfl_advection * h / std::max(speed, 1e-300));
    if (!world.find("water") && !world.find("soil"))
      limits.advection = std::min(limits.advection, n.advection_ratio_max * step);
  }
  std::size_t bytes() const override { return bodies_.bytes(); }

 private:
  void kick(const World<Dim>& world, ParticleSet<Dim>& set, std::size_t body) const {
    const Clock& clock = world.clock;
    const double dt = clock.dt_solid, share = 1.0 / clock.solid_steps_each;
    const bool first = clock.solid_step == 0;
    const auto& x = set.vector(fields::position);
    const auto& v = set.vector(fields::velocity);
    const auto& m = set.scalar(fields::mass);
    const auto& sum = set.vector(fields::acceleration_sum);
    const Field<Vec<Dim>>* fluid =
        set.has(fields::fluid_force) ? &set.vector(fields::fluid_force) : nullptr;
    auto& mean_a = set.vector(fields::acceleration);
    const auto& particles = bodies_.particles(body);

    RigidMotion motion = bodies_.motion(world, body);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const Index i : particles) {
      Vec<Dim> f = m[i] * (sum[i] + world.body_acceleration(x[i]));
      if (fluid) f += (*fluid)[i];
      force += to_space<Dim>(f);
      torque += (to_space<Dim>(x[i]) - motion.center).cross(to_space<Dim>(f));
      // Until the new velocity is known, with the old one.
      mean_a[i] = (first ? Vec<Dim>(Vec<Dim>::Zero()) : mean_a[i]) - v[i] * (share / dt);
    }
    motion.velocity += dt / motion.mass * force;
    motion.spin += dt * torque;
    bodies_.advance(set, particles, motion, 0.5 * dt);
    for (const Index i : particles) mean_a[i] += v[i] * (share / dt);
  }

  RigidBodies<Dim> bodies_;
  mutable std::optional<double> beside_;  // bound of the acoustic step, s
  double sound_ = 0;                      // of the stiffest contact, m/s
};

const RegisterEffect<RigidKick> registered_rigid_kick;

}  // namespace
}  // namespace sphgeo
