#include <cmath>

#include "effects/effect.h"
#include "effects/pore_water.h"

namespace sphgeo {
namespace {

/// Force of the pore pressure on the soil, -n^s grad p (Eqs. 11, 46).
///
/// The paper interpolates p to the soil (Eq. 47) and takes its gradient there; with the water's
/// -n^w grad p, taken elsewhere with another kernel, both do not add up to the gradient of the
/// mixture's pressure, and momentum comes from nowhere wherever the porosity varies. Here the
/// pressure force of each water particle on the mixture, F_i = -V_i grad p, is known from the sums
/// of the water (walls included) and antisymmetric in its pairs. The water takes n^w_i F_i of it,
/// and the soil around the rest, n^s_i F_i, spread with the weights P of the mean velocity
/// (pore_water.h). So momentum is exact, and the power of these forces is that of p on the
/// divergence of Eq. 58, which is built with the same mean: the pair takes no energy from the scene
/// and gives none to it.
template <int Dim>
class PorePressure final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"pore_pressure", Stage::force, "Eqs. 11, 46, 49",
            "force of the pore pressure on the soil: buoyancy and seepage", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    if (!world.parameters().soil.deformable) return {"no skeleton is deformable"};
    return {std::make_unique<PorePressure>(),
            "there are water and soil with a deformable skeleton"};
  }

  std::string acts_on() const override { return "soil near water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::water_fraction, Access::read},
             {"water", &fields::density, Access::read},
             {"water", &fields::mass, Access::read},
             {"water", &fields::pressure_force, Access::read},
             {"soil", &fields::acceleration_sum, Access::add},
             {"soil", &fields::water_acceleration, Access::write}},
            {{"soil", "water"}, {"water", "soil"}}};
    need_pore_pairs<Dim>(n);
    n.record<Force>("water", Access::scratch);
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    const auto& n = water_->scalar(fields::water_fraction);
    const auto& rho = water_->scalar(fields::density);
    const auto& m = water_->scalar(fields::mass);
    const auto& force = water_->vector(fields::pressure_force);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Force, T>(world, "water");
      for_targets(world.list("water", "soil"), [&](Index i) {
        records[i].put(Force::vector, ((1 - n[i]) * m[i] / (n[i] * rho[i])) * force[i]);
      });
    });
    const SoilParameters& parts = world.parameters().soil;
    const auto& part = soil_->tag(fields::part);
    const auto& mass = soil_->scalar(fields::mass);
    auto& a = soil_->vector(fields::acceleration_sum);
    auto& by_water = soil_->vector(fields::water_acceleration);
    parallel_for(soil_->size(), [&](Index k) { by_water[k].setZero(); });
    gather_vectors<Force>(world, "soil", "water", [&](Index k, const Vec<Dim>& sum) {
      by_water[k] = sum / parts[part[k]].grain_density;  // omega / m
      a[k] += by_water[k];
    });
    // What the water gave less what the soil got.
    const auto given = [&](Index i) -> Vec<Dim> {
      return n[i] < 1 ? Vec<Dim>(((1 - n[i]) * m[i] / (n[i] * rho[i])) * force[i])
                      : Vec<Dim>(Vec<Dim>::Zero());
    };
    const Vec<Dim> left =
        ordered_sum(water_->size(), given) -
        ordered_sum(soil_->size(), [&](Index k) -> Vec<Dim> { return mass[k] * by_water[k]; });
    const double size = ordered_sum(water_->size(), [&](Index i) { return given(i).norm(); });
    left_over_ = size > 0 ? left.norm() / size : 0;
  }

  void tally(std::vector<Tally>& tallies) const override {
    tallies.push_back({"pore_pressure_left_over", "1",
                       "what the pressure forces on water and soil leave of their sum, over their "
                       "size, in the last step",
                       left_over_});
  }

  // Water and soil bound to each other carry a faster wave than either alone. The trace of the two
  // coupled wave equations bounds it: c^2 < c_w^2 (1 + n^s rho^w / (n^w rho^s)) + c_s^2.
  void limit(const World<Dim>& world, StepLimits& limits) const override {
    const auto& n = water_->scalar(fields::water_fraction);
    const SoilParameters& parts = world.parameters().soil;
    double lightest = parts.first.grain_density;
    for (const SoilPart& p : parts.of)
      if (p.moves) lightest = std::min(lightest, p.grain_density);
    const double least = block_min(
        water_->size(), [&](Index i) { return n[i] > 0 ? n[i] : 1.0; }, 1.0);
    if (least >= 1) return;
    const double sound =
        world.parameters().water.sound_speed *
        std::sqrt(1 + (1 - least) / least * world.parameters().water.density / lightest);
    const double rate = std::hypot(sound / water_->smoothing_length(),
                                   parts.fastest_wave / soil_->smoothing_length());
    const double bound = world.parameters().numerics.cfl_acoustic / rate;
    limits.lower_acoustic(bound, "sound in the water of pores");
    limits.advection =
        std::min(limits.advection, world.parameters().numerics.advection_ratio_max * bound);
  }

 private:
  using Force = packed::PoreForce<Dim>;

  double left_over_ = 0;
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<PorePressure> registered_pore_pressure;

}  // namespace
}  // namespace sphgeo
