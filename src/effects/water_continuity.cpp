#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Divergence and density dissipation between two water particles.
template <int Dim, bool Porous>
struct ContinuityPair {
  using Water = packed::WaterState<Dim>;
  using Moving = std::conditional_t<Porous, packed::Mixture<Dim>, Water>;
  Kernel<Dim> kernel;
  double inverse_impedance;  ///< 1 / (rho0 c0)
  Vec<Dim> weight;           ///< rho0 g

  template <class T>
  struct Clear {
    T divergence{};  ///< with the Riemann dissipation, 1/s
  };
  template <class T>
  struct Pores {
    T divergence{}, dissipation{};  ///< 1/s
  };
  template <class T>
  struct Sums : std::conditional_t<Porous, Pores<T>, Clear<T>> {};

  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Moving>& i, const Record<T, Moving>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T gradient = kernel.dw_over_r(r2) * j[Water::volume];
    const T dv_r = dot(i.vec(Moving::velocity) - j.vec(Moving::velocity), r);
    // 2 (p_i - p_j) / (2 rho0 c0) dW/dr: the Riemann velocity U* instead of the mean one. Both
    // sides of the Riemann problem are first taken to the middle of the pair with the hydrostatic
    // gradient: the plain difference of Eq. 58 is not zero in still water, and where the kernel is
    // cut off at the free surface its sum lifts the surface for ever.
    T jump = i[Water::pressure] - j[Water::pressure];
    for (int k = 0; k < Dim; ++k) jump -= T(weight[k]) * r[k];
    const T dissipation = jump * T(inverse_impedance) * length(r2);
    if constexpr (Porous) {
      sum.divergence += dv_r * gradient;
      sum.dissipation += dissipation * gradient;
    } else {
      sum.divergence += (dv_r + dissipation) * gradient;
    }
  }
};

/// Rate of density of the water (Eq. 58), where soil is with the velocity of the mixture (see
/// SoilVelocity).
template <int Dim>
class WaterContinuity final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_continuity", Stage::rate, "Eq. 58",
            "divergence and well-balanced Riemann density dissipation between water particles",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    return {std::make_unique<WaterContinuity>(volume_follows_porosity(world)), "there is water"};
  }

  explicit WaterContinuity(bool porous) : porous_(porous) {}

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::density, Access::read},
             {"water", &fields::density_rate, Access::write}},
            {{"water", "water"}}};
    using Water = packed::WaterState<Dim>;
    n.record<Position<Dim>>("water", Access::read);
    if (porous_) {
      n.fields.push_back({"water", &fields::water_fraction, Access::read});
      n.record<Water>("water", Access::read, Water::volume, Water::pressure);
      n.record<packed::Mixture<Dim>>("water", Access::read);
    } else {
      n.record<Water>("water", Access::read);
    }
    return n;
  }

  void prepare(World<Dim>& world) override {
    ParticleSet<Dim>& water = world.set("water");
    density_ = &water.scalar(fields::density);
    rate_ = &water.scalar(fields::density_rate);
  }

  void apply(World<Dim>& world) override {
    if (porous_) run<true>(world);
    else run<false>(world);
  }

 private:
  template <bool Porous>
  void run(World<Dim>& world) {
    using Pair = ContinuityPair<Dim, Porous>;
    const WaterParameters& w = world.parameters().water;
    const Pair pair{Kernel<Dim>(world.set("water").smoothing_length()),
                    1 / (w.density * w.sound_speed), w.density * world.gravity()};
    const Field<double>* n = volume_share(world);
    const Field<double>* scale = gradient_scale(world);
    world.with_pair_precision([&](auto number) {
      const auto records = read_records<typename Pair::Moving, decltype(number)>(world, "water");
      gather<Pair::template Sums>(
          world.list("water", "water"), records, records, pair, [&](Index i, const auto& sum) {
            if constexpr (Porous)
              (*rate_)[i] =
                  (*density_)[i] * (*scale)[i] * (sum.divergence / (*n)[i] + sum.dissipation);
            else (*rate_)[i] = (*density_)[i] * sum.divergence;
          });
    });
  }

  bool porous_;
  Field<double>* density_ = nullptr;
  Field<double>* rate_ = nullptr;
};

const RegisterEffect<WaterContinuity> registered_water_continuity;

}  // namespace
}  // namespace sphgeo
