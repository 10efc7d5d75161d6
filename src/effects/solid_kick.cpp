#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "deck/motion.h"
#include "effects/light_solids.h"
#include "effects/solid_phase.h"

namespace sphgeo {
namespace {

/// Velocity and position of elastic solids at the end of their step (Eqs. 100, 101), what Eq. 95
/// averages, and the bounds of their clock.
template <int Dim>
class SolidKick final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {
        "solid_kick", Stage::solid_kick, "Eqs. 94, 95, 100, 101",
        "velocity and position of elastic solids at the end of their step; bound of their clock",
        false};
  }
  static Binding<Dim> bind(const World<Dim>& world) { return bind_solids<SolidKick>(world); }

  explicit SolidKick(std::string set) : set_(std::move(set)) {}
  const std::string& set_name() const { return set_; }

  std::string acts_on() const override { return set_; }
  Needs needs() const override {
    return {{{set_, &fields::acceleration_sum, Access::read},
             {set_, &fields::clamp, Access::read},
             {set_, &fields::fluid_force, Access::read, true},
             {set_, &fields::position, Access::update},
             {set_, &fields::velocity, Access::update},
             {set_, &fields::acceleration, Access::update}},
            {}};
  }

  void apply(World<Dim>& world) override {
    ParticleSet<Dim>& set = world.set(set_);
    const Clock& clock = world.clock;
    const double dt = clock.dt_solid, end = clock.solid_time() + dt,
                 share = 1.0 / clock.solid_steps_each;
    const bool first = clock.solid_step == 0;
    const SolidParameters& parts = world.parameters().solids;
    auto& x = set.vector(fields::position);
    auto& v = set.vector(fields::velocity);
    auto& mean_a = set.vector(fields::acceleration);
    const auto& sum = set.vector(fields::acceleration_sum);
    const auto& m = set.scalar(fields::mass);
    const auto& reference = set.vector(fields::reference_position);
    const auto& part = set.tag(fields::part);
    const auto& clamp = set.tag(fields::clamp);
    const Field<Vec<Dim>>* fluid =
        set.has(fields::fluid_force) ? &set.vector(fields::fluid_force) : nullptr;
    parallel_for(set.size(), [&](Index i) {
      const SolidPart& p = parts[part[i]];
      if (!p.elastic) return;
      Vec<Dim> before = v[i];
      if (clamp[i] < 0) {
        Vec<Dim> a = sum[i] + world.body_acceleration(x[i]);
        if (fluid) a += (*fluid)[i] / m[i];
        // Damping at the mean of both velocities: stable at any rate.
        v[i] = (v[i] * (1 - 0.5 * dt * p.damping) + dt * a) / (1 + 0.5 * dt * p.damping);
        x[i] += 0.5 * dt * v[i];
      } else {
        const Motion* motion = p.clamped[static_cast<std::size_t>(clamp[i])].motion;
        const Vec3 from = to_space<Dim>(reference[i]);
        x[i] = motion ? to_scene<Dim>(motion->position(from, end)) : reference[i];
        v[i] = motion ? to_scene<Dim>(motion->velocity(from, end)) : Vec<Dim>::Zero();
      }
      const Vec<Dim> rate = (v[i] - before) * (share / dt);
      mean_a[i] = first ? rate : Vec<Dim>(mean_a[i] + rate);
    });
  }

  void prepare(World<Dim>& world) override {
    const SolidParameters& parts = world.parameters().solids;
    for (std::size_t b = 0; b < parts.of.size(); ++b)
      if (parts.of[b].elastic && parts.of[b].set == set_) {
        sound_ = std::max(sound_, parts.of[b].wave_speed);
        slowest_ = std::min(slowest_, parts.of[b].wave_speed);
      }
  }

  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const ParticleSet<Dim>& set = world.set(set_);
    const NumericsParameters& n = world.parameters().numerics;
    const double h = set.smoothing_length();
    const auto& v = set.vector(fields::velocity);
    const auto& a = set.vector(fields::acceleration);
    const double speed = std::sqrt(block_max(
        set.size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0));
    const double acceleration = std::sqrt(block_max(
        set.size(), [&](Index i) { return a[i].squaredNorm(); }, 0.0));
    limits.note_speed(set_, speed / slowest_);
    // Eq. 94, with the compression wave: c_0 of Eq. 53 is slower, by 1.7 times at nu = 0.
    const double step = solid_courant(n) * std::min(h / (sound_ + speed),
                                                    std::sqrt(h / std::max(acceleration, 1e-300)));
    limits.solid = std::min(limits.solid, step);
    // Not before: a run that is resumed has no particles yet when it is prepared.
    if (!beside_) beside_ = step_beside_light_solids(world, set_);
    limits.lower_acoustic(*beside_, "a solid lighter than what touches it");
    limits.advection = std::min(limits.advection, n.cfl_advection * h / std::max(speed, 1e-300));
    // Alone, a solid has no configuration to update: the probes decide how often.
    if (!world.find("water") && !world.find("soil"))
      limits.advection = std::min(limits.advection, n.advection_ratio_max * step);
  }

 private:
  std::string set_;
  mutable std::optional<double> beside_;  // bound of the acoustic step, s
  double sound_ = 0, slowest_ = std::numeric_limits<double>::infinity();  // of its bodies, m/s
};

const RegisterEffect<SolidKick> registered_solid_kick;

}  // namespace
}  // namespace sphgeo
