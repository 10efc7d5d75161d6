#include <cmath>

#include "effects/effect.h"
#include "effects/pore_water.h"

namespace sphgeo {
namespace {

/// Drag between water and soil (Eqs. 29 to 31, 46, 59), after all other forces of the step.
///
/// Each water particle meets the soil's mean velocity around it (Eq. 57), and gives its impulse to
/// the soil particles with the weights of that mean: one coefficient for both sides, so momentum is
/// exact. As the drag of fine soil is stiffer than any acoustic step, it is taken with the relative
/// velocity at the end of the step. For a pair of masses m and M that reads
///
///   d (1 + dt (L + Q |d|) V / mu) = d*,   1 / mu = 1 / m + 1 / M,
///
/// with d* the relative velocity that the other forces alone would lead to: a quadratic for |d|,
/// without iteration. Steady seepage comes out exact at any permeability. M is an upper bound of
/// how the soil answers (see WaterFraction); with it the drag takes energy from every motion of the
/// particles, whatever the time step.
template <int Dim>
class Drag final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"drag",
            Stage::force,
            "Eqs. 29-31, 46, 57, 59",
            "drag between water and soil, both ways, implicit in the relative velocity",
            false,
            "water and soil pass through each other without resistance"};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!has_pore_water(world)) return {"there is no water, or there is no soil"};
    std::string laws;
    for (const SoilPart& p : world.parameters().soil.of) {
      if (p.drag == DragLaw::none) continue;
      const std::string law = p.drag == DragLaw::darcy ? "darcy" : "ergun";
      if (laws.find(law) == std::string::npos) laws += (laws.empty() ? "" : " and ") + law;
    }
    if (laws.empty())
      return {
          "no soil has a drag law: neither grain_size nor hydraulic_conductivity is given, or drag "
          "is none"};
    return {std::make_unique<Drag>(world), "there are water and soil; law: " + laws};
  }

  explicit Drag(const World<Dim>& world)
      : deformable_(world.parameters().soil.deformable), moves_(soil_moves(world)) {}

  std::string acts_on() const override {
    return deformable_ ? "water near soil, soil near water" : "water near soil";
  }
  Needs needs() const override {
    Needs n{{{"water", &fields::water_fraction, Access::read},
             {"water", &fields::soil_sum, Access::read},
             {"water", &fields::drag_linear, Access::read},
             {"water", &fields::drag_quadratic, Access::read},
             {"water", &fields::density, Access::read},
             {"water", &fields::mass, Access::read},
             {"water", &fields::acceleration_sum, Access::update},
             {"water", &fields::drag_acceleration, Access::write}},
            {{"water", "soil"}}};
    if (moves_) n.fields.push_back({"soil", &fields::velocity, Access::read});
    if (deformable_) {
      n.fields.push_back({"water", &fields::inverse_soil_mass, Access::read});
      n.fields.push_back({"soil", &fields::acceleration_sum, Access::update});
      n.fields.push_back({"soil", &fields::water_acceleration, Access::add});
      n.lists.push_back({"soil", "water"});
    }
    need_pore_pairs<Dim>(n);
    if (moves_) n.record<Velocity>("soil", Access::scratch);
    n.record<Force>("water", Access::scratch);
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    soil_ = &world.set("soil");
  }

  void apply(World<Dim>& world) override {
    const double dt = world.clock.dt_acoustic;
    auto& drag = water_->vector(fields::drag_acceleration);
    parallel_for(water_->size(), [&](Index i) { drag[i].setZero(); });
    if (moves_) {
      pack_soil(world, dt);
      const auto& grains = water_->scalar(fields::soil_sum);
      // drag holds the velocity of the soil until exchange() has used it.
      gather_vectors<Velocity>(world, "water", "soil", [&](Index i, const Vec<Dim>& sum) {
        if (grains[i] > 0) drag[i] = sum / grains[i];
      });
    }
    exchange(world, dt);
    if (deformable_) push_soil(world);
  }

 private:
  using Velocity = packed::PoreVelocity<Dim>;
  using Force = packed::PoreForce<Dim>;

  // Where the other forces alone would bring the soil's velocity.
  void pack_soil(World<Dim>& world, double dt) {
    const SoilParameters& parts = world.parameters().soil;
    const auto& v = soil_->vector(fields::velocity);
    const auto& part = soil_->tag(fields::part);
    const Field<Vec<Dim>>* a = deformable_ ? &soil_->vector(fields::acceleration_sum) : nullptr;
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Velocity, T>(world, "soil");
      parallel_for(soil_->size(), [&](Index k) {
        records[k].put(Velocity::vector,
                       parts[part[k]].moves ? Vec<Dim>(v[k] + dt * (*a)[k]) : v[k]);
      });
    });
  }

  void exchange(World<Dim>& world, double dt) {
    const auto& n = water_->scalar(fields::water_fraction);
    const auto& linear = water_->scalar(fields::drag_linear);
    const auto& quadratic = water_->scalar(fields::drag_quadratic);
    const auto& rho = water_->scalar(fields::density);
    const auto& m = water_->scalar(fields::mass);
    const auto& v = water_->vector(fields::velocity);
    const Field<double>* inverse_mass =
        deformable_ ? &water_->scalar(fields::inverse_soil_mass) : nullptr;
    auto& a = water_->vector(fields::acceleration_sum);
    auto& drag = water_->vector(fields::drag_acceleration);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Force, T>(world, "water");
      for_targets(world.list("water", "soil"), [&](Index i) {
        const Vec<Dim> ahead = v[i] + dt * a[i] - drag[i];  // d*
        const double volume = m[i] / (n[i] * rho[i]),
                     inverse = 1 / m[i] + (inverse_mass ? (*inverse_mass)[i] : 0.0);
        const double b = 1 + dt * linear[i] * volume * inverse,
                     c = dt * quadratic[i] * volume * inverse, speed = ahead.norm();
        const double share = 2 / (b + std::sqrt(b * b + 4 * c * speed));  // d / d*
        const Vec<Dim> force =
            (volume * (linear[i] + quadratic[i] * share * speed) * share) * ahead;
        drag[i] = force / -m[i];
        a[i] += drag[i];
        records[i].put(Force::vector, force);
      });
    });
  }

  void push_soil(World<Dim>& world) {
    const SoilParameters& parts = world.parameters().soil;
    const auto& part = soil_->tag(fields::part);
    auto& a = soil_->vector(fields::acceleration_sum);
    auto& by_water = soil_->vector(fields::water_acceleration);
    gather_vectors<Force>(world, "soil", "water", [&](Index k, const Vec<Dim>& sum) {
      const Vec<Dim> push = sum / parts[part[k]].grain_density;  // omega / m
      a[k] += push;
      by_water[k] += push;
    });
  }

  bool deformable_, moves_;
  ParticleSet<Dim>* water_ = nullptr;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<Drag> registered_drag;

}  // namespace
}  // namespace sphgeo
