#include "effects/effect.h"
#include "effects/soil_phase.h"

namespace sphgeo {
namespace {

/// Stress between two soil particles by the Riemann flux, and its part in the volume fraction.
template <int Dim, bool Uniform>
struct StressPair {
  Kernel<Dim> kernel;
  double impedance;      ///< rho0 c0, when all soil is alike
  double inverse_sound;  ///< 1 / c0, when all soil is alike
  double limiter;        ///< xi^s
  double damping;        ///< of the motion that the velocity gradient does not see

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};  ///< per unit volume
    T rate{};                 ///< of the volume fraction, by U* - mean of U
  };

  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T, 3>& i, const Record<Dim, T, 3>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    using namespace soil_slot;
    const T gradient = kernel.dw_over_r(r2) * j[volume];
    const T inverse = inverse_length(r2);
    // U_L - U_R = -(v_i - v_j) . e (Eq. 52).
    const T closing = max(T(0), -(dot(i.vec(velocity) - j.vec(velocity), r) * inverse));
    T two_stress[stress_size<Dim>];
    for (int k = 0; k < stress_size<Dim>; ++k) two_stress[k] = i[stress + k] + j[stress + k];
    const T p_i = mean_pressure<Dim>(i), p_j = mean_pressure<Dim>(j);
    // Eqs. 50, 51, 54: twice sigma* is the sum of both stresses less `excess` in pressure.
    T excess, jump;
    if constexpr (Uniform) {
      const T beta = min(T(limiter * inverse_sound) * closing, T(1));
      excess = beta * T(impedance) * closing;
      jump = (p_i - p_j) * T(1 / impedance);
    } else {
      const T z_i = i[soil_slot::impedance], z_j = j[soil_slot::impedance];
      // The null record that pads the lists has no impedance, but i has.
      const T share = T(1) / (z_i + z_j);
      const T beta = min(T(limiter) * (i[density] + j[density]) * share * closing, T(1));
      excess = (z_i - z_j) * share * (p_j - p_i) + T(2) * beta * z_i * z_j * share * closing;
      const T approach = -(dot(i.vec(velocity) - j.vec(velocity), r) * inverse);
      jump = ((z_i - z_j) * approach + T(2) * (p_i - p_j)) * share;
    }
    // e . (v_i - v_j - (D_i + D_j)/2 . r): how fast the pair parts beyond the smooth motion around it.
    T smooth[stress_size<Dim>];
    for (int k = 0; k < stress_size<Dim>; ++k) smooth[k] = T(0.5) * (i[strain_rate + k] + j[strain_rate + k]);
    const T parting = dot(i.vec(velocity) - j.vec(velocity) - times(smooth, r), r) * inverse;
    excess -= T(damping * impedance) * parting;
    sum.force += gradient * times(two_stress, r) - (excess * gradient) * r;
    sum.rate += j[volume_fraction] * jump * gradient * (r2 * inverse);
  }
};

/// Momentum of the soil (Eq. 49 without water and solids), and the Riemann dissipation in Eq. 48.
template <int Dim>
class SoilMomentum final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_momentum", Stage::force, "Eqs. 48-54", "stress between soil particles (Riemann)", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    if (!SoilParts(world).deformable) return {"no skeleton is deformable"};
    return {std::make_unique<SoilMomentum>(), "there is soil with a deformable skeleton"};
  }

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    return {{{"soil", &fields::volume, Access::read}, {"soil", &fields::stress, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::acceleration_sum, Access::add}, {"soil", &fields::volume_fraction_rate, Access::write}},
            {{"soil", "soil"}}};
  }

  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    const SoilParts parts(world);
    if (parts.uniform) run<true>(world, parts);
    else run<false>(world, parts);
  }

 private:
  template <bool Uniform>
  void run(World<Dim>& world, const SoilParts& parts) {
    using Pair = StressPair<Dim, Uniform>;
    const Pair pair{soil_kernel(*soil_), parts.first.impedance(), 1 / parts.first.sound_speed, soil_limiter(world), std::getenv("DAMP") ? std::atof(std::getenv("DAMP")) : 0.0};
    auto& sum_of_forces = soil_->vector(fields::acceleration_sum);
    auto& rate = soil_->scalar(fields::volume_fraction_rate);
    const auto& m = soil_->scalar(fields::mass);
    const auto& volume = soil_->scalar(fields::volume);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = with(world.records("soil", 0).template get<T>(), world.records("soil", 1).template get<T>(), world.records("soil", 2).template get<T>());
      gather<Pair::template Sums>(world.list("soil", "soil"), records, records, pair, [&](Index i, const auto& sum) {
        sum_of_forces[i] += to_vec(sum.force) * (volume[i] / m[i]);
        rate[i] = sum.rate;
      });
    });
  }

  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilMomentum> registered;

}  // namespace
}  // namespace sphgeo
