#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Velocity and position at the end of the acoustic step (Eqs. 97, 98), and the step bounds of the
/// water (Eqs. 91, 92).
template <int Dim>
class WaterKick final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_kick", Stage::kick, "Eqs. 91, 92, 97, 98",
            "velocity and position at the end of the step; bounds of both clocks", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterKick>(!world.frozen_geometry()), "there is water"};
  }

  explicit WaterKick(bool current_geometry) : current_geometry_(current_geometry) {}

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::velocity, Access::update},
             {"water", &fields::position, Access::update},
             {"water", &fields::acceleration, Access::write},
             {"water", &fields::acceleration_sum, Access::read}},
            {}};
    n.record<Water>("water", Access::write, Water::velocity);
    if (current_geometry_) n.record<Position<Dim>>("water", Access::update);
    return n;
  }

  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    const double dt = world.clock.dt_acoustic;
    auto& x = water_->vector(fields::position);
    auto& v = water_->vector(fields::velocity);
    auto& a = water_->vector(fields::acceleration);
    const auto& sum = water_->vector(fields::acceleration_sum);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Water, T>(world, "water");
      fastest_.resize(static_cast<std::size_t>((water_->size() + block_size - 1) / block_size));
      parallel_blocks(water_->size(), block_size, [&](Index begin, Index end, Index b) {
        double fastest = 0;
        for (Index i = begin; i < end; ++i) {
          a[i] = sum[i];
          v[i] += dt * sum[i];
          x[i] += 0.5 * dt * v[i];
          fastest = max_or_nan(fastest, v[i].squaredNorm());
          records[i].put(Water::velocity, v[i]);
        }
        fastest_[static_cast<std::size_t>(b)] = fastest;
      });
    });
    if (current_geometry_) world.pack_positions(*water_);
    arrangement_ = world.arrangement();
  }

  std::size_t bytes() const override { return fastest_.capacity() * sizeof(double); }

  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const NumericsParameters& n = world.parameters().numerics;
    const WaterParameters& w = world.parameters().water;
    const double h = water_->smoothing_length();
    const double speed = largest_speed(world);
    limits.note_speed("water", speed / w.sound_speed);
    limits.water_mach = speed / w.sound_speed;
    const double acoustic = n.cfl_acoustic * h / (w.sound_speed + speed);  // Eq. 92
    limits.lower_acoustic(acoustic, "sound in water");
    // Eq. 91. At rest h/|v| has no bound: then the acoustic step bounds it, by a ratio that equals
    // what Eqs. 91 and 92 give together at a tenth of the speed of sound.
    double advection =
        std::min(n.advection_ratio_max * acoustic, n.cfl_advection * h / std::max(speed, 1e-300));
    if (w.viscosity > 0)
      advection = std::min(advection, n.cfl_advection * w.density * h * h / w.viscosity);
    limits.advection = std::min(limits.advection, advection);
  }

 private:
  using Water = packed::WaterState<Dim>;

  // The largest speed, m/s; NaN if there is one. The kick has looked at all, unless particles have
  // been lost or read from a file since then.
  double largest_speed(const World<Dim>& world) const {
    if (arrangement_ == world.arrangement())
      return std::sqrt(std::accumulate(fastest_.begin(), fastest_.end(), 0.0, max_or_nan));
    const auto& v = water_->vector(fields::velocity);
    return std::sqrt(block_max(
        water_->size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0));
  }

  bool current_geometry_;
  ParticleSet<Dim>* water_ = nullptr;
  std::vector<double> fastest_;  // largest squared speed of each block after the last kick
  long arrangement_ = -1;        // during which that kick was
};

const RegisterEffect<WaterKick> registered_water_kick;

}  // namespace
}  // namespace sphgeo
