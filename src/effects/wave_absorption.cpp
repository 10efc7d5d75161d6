#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/indices_where.h"
#include "deck/motion.h"
#include "effects/effect.h"
#include "sph/kernel.h"
#include "sph/parameters.h"
#include "sph/surface_height.h"

namespace sphgeo {
namespace {

/// Active wave absorption. The speed that is added to a piston: that of water under a wave as
/// high as what gauges before the piston measure beyond its own waves (Schaeffer and Klopman 2000).
/// wall_motion moves it.
template <int Dim>
class WaveAbsorption final : public Effect<Dim> {
 public:
  /// The part is the number of the piston among the boundaries.
  WaveAbsorption(const BoundaryMotion& piston, std::int32_t part)
      : piston_(piston), part_(part), waves_(*piston.motion->waves) {}
  static EffectInfo info() {
    return {"wave_absorption", Stage::exchange, "prescribed", "active wave absorption of pistons",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    Binding<Dim> binding("no boundary absorbs waves");
    if (!world.find("water") || !world.find("walls")) return binding;
    const std::vector<BoundaryMotion>& walls = world.parameters().boundary_motions;
    for (std::size_t k = 0; k < walls.size(); ++k)
      if (walls[k].absorbs_waves) {
        binding.effects.push_back(
            std::make_unique<WaveAbsorption>(walls[k], static_cast<std::int32_t>(k)));
        binding.because = "boundary '" + walls[k].name + "' absorbs waves";
      }
    return binding;
  }

  std::string acts_on() const override { return "boundary '" + piston_.name + "'"; }
  Needs needs() const override {
    return {{{"water", &fields::position, Access::read},
             {"water", &fields::mass, Access::read},
             {"walls", &fields::part, Access::read},
             {"walls", &fields::reference_position, Access::read}},
            {}};
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    kernel_ = Kernel<Dim>(water_->smoothing_length());
    state_ = &world.piston(piston_.name);
  }

  void apply(World<Dim>& world) override {
    const Motion& motion = *piston_.motion;
    const double now = world.clock.time, passed = now - last_;
    last_ = now;
    state_->wanted = 0;
    state_->lag = lag();
    if (now < motion.from || (motion.until && now >= *motion.until)) return;
    // Not in prepare(): a run that goes on has no particles yet when it gets there.
    if (gauges_.empty()) place_gauges(world);
    const std::optional<double> level =
        level_before_it(world.parameters().water.density,
                        motion.position(front_, now) + state_->shift * waves_.direction);
    if (!level) return;
    const double distance =
        waves_.direction.dot(motion.position(front_, now) - front_) + state_->shift + ahead();
    const double seen = *level - waves_.elevation(distance, now - motion.from) -
                        waves_.evanescent(distance) * state_->shift;
    // The level counts from its own slow mean: water at rest, and the set-up by waves, must not
    // make the piston drift.
    const double slow = 5 * waves_.period;
    mean_ = !begun_ ? seen : mean_ + (seen - mean_) * -std::expm1(-passed / slow);
    begun_ = true;
    const double fastest = waves_.absorbing_rate() * waves_.height;
    state_->wanted = std::clamp(-waves_.absorbing_rate() * (seen - mean_) - state_->shift / slow,
                                -fastest, fastest);
  }

  void save(StateSink& sink, const std::string& at) const override {
    sink.put_number(at + "mean", mean_);
    sink.put_count(at + "begun", begun_ ? 1 : 0);
    sink.put_number(at + "time", last_);
  }
  void load(const StateSource& source, const std::string& at) override {
    mean_ = source.number(at + "mean");
    begun_ = source.count(at + "begun") != 0;
    last_ = source.number(at + "time");
  }
  std::size_t bytes() const override { return gauges_.capacity() * sizeof(Vec3); }
  void tally(std::vector<Tally>& out) const override {
    out.push_back(
        {"piston_shift_" + piston_.name, "m",
         "how far boundary '" + piston_.name + "' is from where its waves alone would have it",
         state_->shift});
  }

 private:
  /// Gauges stand where a kernel just misses the piston.
  double ahead() const { return kernel_.support(); }
  /// What comes back reaches the gauges earlier than the piston by their distance: a welcome time
  /// to smooth over.
  double lag() const {
    return std::max(ahead() * waves_.wave_number() * waves_.period / (2 * std::numbers::pi),
                    waves_.period / 40);
  }

  /// A row along the front of the piston, as far as it reaches.
  void place_gauges(const World<Dim>& world) {
    const auto& walls = world.set("walls");
    const Vec3 along = waves_.direction.cross(Vec3::UnitZ());
    double front = -INFINITY, low = INFINITY, high = -INFINITY;
    for (Index i = 0; i < walls.size(); ++i) {
      if (walls.tag(fields::part)[i] != part_) continue;
      const Vec3 x = to_space<Dim>(walls.vector(fields::reference_position)[i]);
      front = std::max(front, waves_.direction.dot(x));
      low = std::min(low, along.dot(x));
      high = std::max(high, along.dot(x));
    }
    front_ = (front + 0.5 * walls.spacing()) * waves_.direction;
    const double apart = 4 * water_->spacing();
    const int count =
        std::isfinite(low) ? std::clamp(static_cast<int>((high - low) / apart), 1, 8) : 0;
    for (int k = 0; k < count; ++k)
      gauges_.push_back((low + (high - low) * (k + 0.5) / count) * along);
  }

  /// Mean height of the surface at the gauges that have water.
  std::optional<double> level_before_it(double density, const Vec3& front) const {
    const Vec3 at = front + ahead() * waves_.direction;
    const auto& x = water_->vector(fields::position);
    const auto& mass = water_->scalar(fields::mass);
    const double reach = kernel_.support();
    std::vector<std::vector<Index>> near(gauges_.size());
    const auto in_reach = indices_where(water_->size(), [&](Index i) {
      return !(std::abs(waves_.direction.dot(to_space<Dim>(x[i]) - at)) > reach);
    });
    for (const std::uint32_t i : in_reach) {
      const Vec3 p = to_space<Dim>(x[i]);
      for (std::size_t g = 0; g < gauges_.size(); ++g) {
        const Vec3 off = p - at - gauges_[g];
        if (std::hypot(off.x(), off.y()) <= reach) near[g].push_back(i);
      }
    }
    double sum = 0, found = 0;
    for (std::size_t g = 0; g < gauges_.size(); ++g) {
      double top = -INFINITY, bottom = INFINITY;
      for (const Index i : near[g]) {
        top = std::max(top, x[i][Dim - 1]);
        bottom = std::min(bottom, x[i][Dim - 1]);
      }
      const auto filled = [&](double z) {
        Vec3 place = at + gauges_[g];
        place.z() = z;
        const Vec<Dim> here = to_scene<Dim>(place);
        double share = 0;
        for (const Index i : near[g])
          share += mass[i] / density * kernel_.w((x[i] - here).squaredNorm());
        return share;
      };
      if (const auto z = surface_height(top, bottom, water_->spacing(), filled)) {
        sum += *z;
        found += 1;
      }
    }
    return found > 0 ? std::optional(sum / found) : std::nullopt;
  }

  const BoundaryMotion& piston_;
  std::int32_t part_;
  const Waves& waves_;
  Kernel<Dim> kernel_;
  Vec3 front_ = Vec3::Zero();  ///< a point of the piston's face at rest
  std::vector<Vec3> gauges_;   ///< along the face, from there
  PistonState* state_ = nullptr;
  double mean_ = 0;     ///< slow mean of the gauges, m
  bool begun_ = false;  ///< whether there is one
  double last_ = 0;     ///< time of the last call, s
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaveAbsorption> registered_wave_absorption;

}  // namespace
}  // namespace sphgeo
