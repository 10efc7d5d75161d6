#include "core/parallel.h"
#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Density and position at the middle of the acoustic step, pressure and volume there (Eqs. 26, 27,
/// 96).
template <int Dim>
class WaterPredict final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_predict", Stage::predict, "Eqs. 26, 27, 96",
            "density, position, pressure and volume at the middle of the step", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterPredict>(world), "there is water"};
  }

  explicit WaterPredict(const World<Dim>& world) : current_geometry_(!world.frozen_geometry()) {
    need_volume_share(world, volume_);
    if (volume_follows_porosity(world))
      volume_.fields.push_back({"water", &fields::gradient_scale, Access::read});
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::density, Access::update},
             {"water", &fields::position, Access::update},
             {"water", &fields::density_rate, Access::read},
             {"water", &fields::velocity, Access::read},
             {"water", &fields::mass, Access::read},
             {"water", &fields::surface, Access::read},
             {"water", &fields::pressure, Access::write},
             {"water", &fields::volume, Access::write}},
            {}};
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    n.record<packed::WaterState<Dim>>("water", Access::write);
    if (current_geometry_) n.record<Position<Dim>>("water", Access::update);
    return n;
  }

  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    const WaterParameters& w = world.parameters().water;
    const double half = 0.5 * world.clock.dt_acoustic, c2 = w.sound_speed * w.sound_speed;
    auto& rho = water_->scalar(fields::density);
    auto& x = water_->vector(fields::position);
    auto& p = water_->scalar(fields::pressure);
    auto& volume = water_->scalar(fields::volume);
    const auto& rate = water_->scalar(fields::density_rate);
    const auto& v = water_->vector(fields::velocity);
    const auto& m = water_->scalar(fields::mass);
    const auto& surface = water_->tag(fields::surface);
    const Field<double>* share = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      using Water = packed::WaterState<Dim>;
      const auto records = write_records<Water, T>(world, "water");
      parallel_for(water_->size(), [&](Index i) {
        rho[i] += half * rate[i];
        x[i] += half * v[i];
        p[i] = c2 * (rho[i] - w.density);
        // Negative pressure is cut off between drops that separate: it would hold a particle back
        // over the whole advection step, until pairs are found anew, and let it go with more energy
        // than it had.
        if (surface[i] == spray) p[i] = std::max(p[i], 0.0);
        volume[i] = m[i] / (share ? (*share)[i] * rho[i] : rho[i]);
        const auto record = records[i];
        record.put(Water::volume, scale ? volume[i] * (*scale)[i] : volume[i]);
        record.put(Water::pressure, p[i]);
        record.put(Water::velocity, v[i]);
      });
    });
    if (current_geometry_) world.pack_positions(*water_);
  }

  void bounds(const World<Dim>& world, std::vector<FieldBound>& watched) const override {
    const double rho0 = world.parameters().water.density,
                 most = world.parameters().numerics.density_bound * rho0;
    watched.push_back({"water", &fields::density, rho0 - most, rho0 + most,
                       "water that comes apart faster than its time step resolves: something has "
                       "thrown it, such as a start inside of a wall or body",
                       "pressures of the order of rho0 c0^2: bodies that start inside each other, "
                       "or a sound speed that is too low"});
  }

 private:
  Needs volume_;  // what the volume needs beside mass and density
  bool current_geometry_;
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<WaterPredict> registered_water_predict;

}  // namespace
}  // namespace sphgeo
