#include <cmath>

#include "core/parallel.h"
#include "deck/expression.h"
#include "effects/effect.h"
#include "effects/soil_phase.h"

namespace sphgeo {
namespace {

/// Velocity and position at the end of the acoustic step (Eqs. 97, 98), and the step bounds of the
/// soil (Eqs. 91, 92). A fixed skeleton stays, a prescribed one follows the velocity of its body.
template <int Dim>
class SoilKick final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_kick", Stage::kick, "Eqs. 91, 92, 97, 98",
            "velocity and position of soil at the end of the step; bounds of both clocks", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    return {std::make_unique<SoilKick>(world), "there is soil"};
  }

  explicit SoilKick(const World<Dim>& world)
      : deformable_(world.parameters().soil.deformable),
        current_geometry_(world.parameters().numerics.soil_pair_geometry == PairGeometry::current) {
  }

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::velocity, Access::update},
             {"soil", &fields::position, Access::update},
             {"soil", &fields::acceleration, Access::write}},
            {}};
    if (deformable_) n.fields.push_back({"soil", &fields::acceleration_sum, Access::read});
    n.record<packed::SoilState<Dim>>("soil", Access::write, packed::SoilState<Dim>::velocity);
    if (current_geometry_) n.record<Position<Dim>>("soil", Access::update);
    return n;
  }

  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    const double dt = world.clock.dt_acoustic;
    const SoilParameters& parts = world.parameters().soil;
    auto& x = soil_->vector(fields::position);
    auto& v = soil_->vector(fields::velocity);
    auto& a = soil_->vector(fields::acceleration);
    const Field<Vec<Dim>>* sum = deformable_ ? &soil_->vector(fields::acceleration_sum) : nullptr;
    const auto& part = soil_->tag(fields::part);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<packed::SoilState<Dim>, T>(world, "soil");
      std::optional<RecordPacking<Position<Dim>, T>> positions;
      if (current_geometry_) positions = write_records<Position<Dim>, T>(world, "soil");
      parallel_for(soil_->size(), [&](Index i) {
        if (parts[part[i]].moves) {
          a[i] = (*sum)[i];
          v[i] += dt * a[i];
          x[i] += 0.5 * dt * v[i];
        } else if (parts[part[i]].fixed) {
          a[i].setZero();
        } else {
          follow(*parts[part[i]].velocity, dt, x[i], v[i], a[i]);
        }
        records[i].put(packed::SoilState<Dim>::velocity, v[i]);
        if (positions) positions->set_position(i, x[i]);
      });
    });
  }

  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const NumericsParameters& n = world.parameters().numerics;
    const SoilParameters& parts = world.parameters().soil;
    const double h = soil_->smoothing_length();
    if (!parts.deformable && world.find("water")) return;  // at rest or led: no wave runs in it
    const double sound = parts.deformable ? parts.fastest_wave : parts.first.sound_speed;
    const auto& v = soil_->vector(fields::velocity);
    const double speed = std::sqrt(block_max(
        soil_->size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0));
    limits.note_speed("soil", speed / sound);
    // Eq. 92, with the compression wave: it is faster than the c_0 of Eq. 53, up to 1.7 times at nu
    // = 0.
    const double acoustic = n.cfl_acoustic * h / (sound + speed);
    limits.lower_acoustic(acoustic, "waves in soil");
    // Eq. 91; at rest the acoustic step bounds it, as for water.
    limits.advection = std::min(
        limits.advection,
        std::min(n.advection_ratio_max * acoustic, n.cfl_advection * h / std::max(speed, 1e-300)));
  }

 private:
  // Midpoint rule through a velocity field; x comes at the middle of the step, reached with v.
  static void follow(const VectorFormula& velocity, double dt, Vec<Dim>& x, Vec<Dim>& v,
                     Vec<Dim>& a) {
    const auto field = [&](const Vec<Dim>& at) {
      const Vec3 p = to_space<Dim>(at);
      return to_scene<Dim>(Vec3(velocity[0](p, 0), velocity[1](p, 0), velocity[2](p, 0)));
    };
    const Vec<Dim> start = x - 0.5 * dt * v;
    x = start + dt * field(x);
    const Vec<Dim> end = field(x);
    a = dt > 0 ? Vec<Dim>((end - v) / dt) : Vec<Dim>::Zero();
    v = end;
  }

  bool deformable_, current_geometry_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilKick> registered_soil_kick;

}  // namespace
}  // namespace sphgeo
