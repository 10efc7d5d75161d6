#include "effects/effect.h"
#include "effects/pore_water.h"

namespace sphgeo {
namespace {

/// Velocity of the soil at the water (Eq. 57), and that of the mixture, n^w v^w + n^s v^s, packed
/// in place of that of the water: the divergence of Eq. 58 is taken of it.
///
/// Eq. 58 has the bracket n_i v_i - n_j v_j - (1 - n_i) v_i^s, which does not vanish when water
/// and soil move together. Eq. 23 asks for the divergence of n^w v^w + n^s v^s, whose difference
/// between two water particles does.
template <int Dim>
class SoilVelocity final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_velocity", Stage::rate, "Eqs. 23, 57, 58",
            "velocity of the soil at the water, and of the mixture", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    if (!world.parameters().water.follows_porosity)
      return {"numerics.pore_water is constant_volume: the porosity does not enter the density"};
    return {std::make_unique<SoilVelocity>(world), "there are water and soil"};
  }

  explicit SoilVelocity(const World<Dim>& world) : moves_(soil_moves(world)) {}

  std::string acts_on() const override { return "water near soil"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::water_fraction, Access::read},
             {"water", &fields::soil_sum, Access::read},
             {"water", &fields::velocity, Access::read},
             {"water", &fields::soil_velocity, Access::write}},
            {{"water", "soil"}}};
    // Where no soil is, the mixture is the water.
    n.record<packed::WaterState<Dim>>("water", Access::read, packed::WaterState<Dim>::velocity);
    n.record<packed::Mixture<Dim>>("water", Access::write);
    if (moves_) {
      n.fields.push_back({"soil", &fields::velocity, Access::read});
      need_pore_pairs<Dim>(n);
      n.record<packed::PoreVelocity<Dim>>("soil", Access::scratch);
    }
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    auto& soil_velocity = water_->vector(fields::soil_velocity);
    const auto& n = water_->scalar(fields::water_fraction);
    const auto& v = water_->vector(fields::velocity);
    parallel_for(water_->size(), [&](Index i) { soil_velocity[i].setZero(); });
    if (moves_) {
      const auto& of_soil = soil_->vector(fields::velocity);
      world.with_pair_precision([&](auto number) {
        const auto records = write_records<Velocity, decltype(number)>(world, "soil");
        parallel_for(soil_->size(), [&](Index k) { records[k].put(Velocity::vector, of_soil[k]); });
      });
      const auto& grains = water_->scalar(fields::soil_sum);
      gather_vectors<Velocity>(world, "water", "soil", [&](Index i, const Vec<Dim>& sum) {
        if (grains[i] > 0) soil_velocity[i] = sum / grains[i];
      });
    }
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<packed::Mixture<Dim>, T>(world, "water");
      for_targets(world.list("water", "soil"), [&](Index i) {
        const Vec<Dim> flux = n[i] * v[i] + (1 - n[i]) * soil_velocity[i];
        records[i].put(packed::Mixture<Dim>::velocity, flux);
      });
    });
  }

 private:
  using Velocity = packed::PoreVelocity<Dim>;

  bool moves_;
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilVelocity> registered_soil_velocity;

}  // namespace
}  // namespace sphgeo
