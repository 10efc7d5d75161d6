#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Pressure and viscosity between two water particles. In pores, the pressure force is also that on
/// the soil, and its sum is kept apart.
template <int Dim, bool Viscous, bool Porous>
struct MomentumPair {
  using Water = packed::WaterState<Dim>;
  Kernel<Dim> kernel;
  RiemannFlux riemann;
  double two_eta;    ///< eta (n_i + n_j) with n = 1
  double softening;  ///< 0.01 h^2

  template <class T>
  struct Clear {
    LaneVec<Dim, T> force{};  ///< per unit volume
  };
  template <class T>
  struct Pores {
    LaneVec<Dim, T> force{}, friction{};
  };
  template <class T>
  struct Sums : std::conditional_t<Porous && Viscous, Pores<T>, Clear<T>> {};

  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Water>& i, const Record<T, Water>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const LaneVec<Dim, T> dv = i.vec(Water::velocity) - j.vec(Water::velocity);
    // U_L - U_R = -(v_i - v_j) . e (Eq. 62).
    const T approach = -(dot(dv, r) * inverse_length(r2));
    const T gradient = kernel.dw_over_r(r2) * j[Water::volume];
    const T two_p_star = i[Water::pressure] + j[Water::pressure] + riemann.dissipation(approach);
    sum.force -= (two_p_star * gradient) * r;
    // (n_i + n_j) V_j / n_i of Eq. 60, by Eq. 27 for equal masses.
    if constexpr (Viscous && Porous)
      sum.friction += (T(0.5 * two_eta) * (gradient + kernel.dw_over_r(r2) * i[Water::volume]) *
                       r2 / (r2 + T(softening))) *
                      dv;
    else if constexpr (Viscous)
      sum.force += (T(two_eta) * gradient * r2 / (r2 + T(softening))) * dv;
  }
};

/// Momentum of the water: gravity, pressure by the Riemann flux, and viscosity (Eq. 60).
/// It sets the sum of accelerations to which all other forces on the water are added.
template <int Dim>
class WaterMomentum final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_momentum", Stage::force, "Eqs. 60-63",
            "gravity, pressure (Riemann) and viscosity between water particles", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterMomentum>(world.find("soil") != nullptr),
            world.parameters().water.viscosity > 0 ? "there is water"
                                                   : "there is water; inviscid: no viscous term"};
  }

  explicit WaterMomentum(bool porous) : porous_(porous) {}

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::density, Access::read},
             {"water", &fields::acceleration_sum, Access::write}},
            {{"water", "water"}}};
    if (porous_) n.fields.push_back({"water", &fields::pressure_force, Access::write});
    n.record<Position<Dim>>("water", Access::read);
    n.record<packed::WaterState<Dim>>("water", Access::read);
    return n;
  }

  void prepare(World<Dim>& world) override {
    ParticleSet<Dim>& water = world.set("water");
    density_ = &water.scalar(fields::density);
    acceleration_ = &water.vector(fields::acceleration_sum);
  }

  void apply(World<Dim>& world) override {
    const bool viscous = world.parameters().water.viscosity > 0;
    if (porous_) viscous ? run<true, true>(world) : run<false, true>(world);
    else viscous ? run<true, false>(world) : run<false, false>(world);
  }

 private:
  template <bool Viscous, bool Porous>
  void run(World<Dim>& world) {
    using Pair = MomentumPair<Dim, Viscous, Porous>;
    const WaterParameters& w = world.parameters().water;
    const double h = world.set("water").smoothing_length();
    const Vec<Dim> g = world.gravity();
    const Pair pair{Kernel<Dim>(h), RiemannFlux(w), 2 * w.viscosity, 0.01 * h * h};
    const Field<double>* scale = Porous ? gradient_scale(world) : nullptr;
    Field<Vec<Dim>>* pressure_force =
        Porous ? &world.set("water").vector(fields::pressure_force) : nullptr;
    world.with_pair_precision([&](auto number) {
      const auto records = read_records<packed::WaterState<Dim>, decltype(number)>(world, "water");
      gather<Pair::template Sums>(world.list("water", "water"), records, records, pair,
                                  [&](Index i, const auto& sum) {
                                    Vec<Dim> force = to_vec(sum.force);
                                    if constexpr (Porous) {
                                      if (scale) force *= (*scale)[i];
                                      (*pressure_force)[i] = force;
                                    }
                                    if constexpr (Porous && Viscous) force += to_vec(sum.friction);
                                    (*acceleration_)[i] = g + force / (*density_)[i];
                                  });
    });
  }

  bool porous_;
  Field<double>* density_ = nullptr;
  Field<Vec<Dim>>* acceleration_ = nullptr;
};

const RegisterEffect<WaterMomentum> registered_water_momentum;

}  // namespace
}  // namespace sphgeo
