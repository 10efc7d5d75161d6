#include "effects/effect.h"
#include "effects/soil_phase.h"

namespace sphgeo {
namespace {

/// Stress between two soil particles by the Riemann flux (Eqs. 49 to 54).
///
/// Eq. 49 has sigma_i + sigma_j. Here each stress comes with the correction B of its particle,
/// by which Eq. 55 is made exact for linear velocities: only then does the work of these forces
/// equal that of the stress on the velocity gradient, pair by pair. With the correction in Eq. 55
/// alone, energy grows without bound near every surface.
template <int Dim, bool Uniform>
struct StressPair {
  Kernel<Dim> kernel;
  double impedance;      ///< rho0 c0, when all soil is alike
  double inverse_sound;  ///< 1 / c0, when all soil is alike
  double limiter;        ///< xi^s
  using Soil = packed::SoilState<Dim>;
  using Parameters = packed::SoilContact<Dim>;
  template <class T>
  using Side = std::conditional_t<Uniform, UniformSoilRecord<Dim, T>, SoilRecord<Dim, T>>;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};  ///< per unit volume
  };

  template <class T>
  void operator()(Sums<T>& sum, const Side<T>& i, const Side<T>& j, const LaneVec<Dim, T>& r,
                  const T& r2) const {
    const T gradient = kernel.dw_over_r(r2) * j[Soil::volume];
    // U_L - U_R = -(v_i - v_j) . e (Eq. 52).
    const T closing =
        max(T(0), -(dot(i.vec(Soil::velocity) - j.vec(Soil::velocity), r) * inverse_length(r2)));
    T stress_i[Dim * Dim], two_stress[Dim * Dim];
    unpack_stress<Dim>(i, stress_i);
    unpack_stress<Dim>(j, two_stress);
    for (int k = 0; k < Dim * Dim; ++k) two_stress[k] += stress_i[k];
    // Eqs. 50, 51, 54: twice sigma* is the sum of both stresses less `excess` in pressure.
    T excess;
    if constexpr (Uniform) {
      const T beta = min(T(limiter * inverse_sound) * closing, T(1));
      excess = beta * T(impedance) * closing;
    } else {
      const T z_i = i[Parameters::impedance], z_j = j[Parameters::impedance];
      // The null record that pads the lists has no impedance, but i has.
      const T share = T(1) / (z_i + z_j);
      const T beta = min(
          T(limiter) * (i[Parameters::density] + j[Parameters::density]) * share * closing, T(1));
      excess = (z_i - z_j) * share * (j[Parameters::pressure] - i[Parameters::pressure]) +
               T(2) * beta * z_i * z_j * share * closing;
    }
    sum.force += gradient * (times(two_stress, r) - excess * r);
  }
};

/// Momentum of the soil (Eq. 49 without water and solids).
template <int Dim>
class SoilMomentum final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_momentum", Stage::force, "Eqs. 49-54", "stress between soil particles (Riemann)",
            false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    if (!world.parameters().soil.deformable) return {"no skeleton is deformable"};
    return {std::make_unique<SoilMomentum>(world.parameters().soil.uniform),
            "there is soil with a deformable skeleton"};
  }

  explicit SoilMomentum(bool uniform) : uniform_(uniform) {}

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::volume, Access::read},
             {"soil", &fields::mass, Access::read},
             {"soil", &fields::position, Access::read},
             {"soil", &fields::acceleration_sum, Access::write}},
            {{"soil", "soil"}}};
    n.record<Position<Dim>>("soil", Access::read);
    need_soil_records<Dim>(n, Access::read, !uniform_);
    return n;
  }

  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    const SoilParameters& parts = world.parameters().soil;
    if (uniform_) run<true>(world, parts);
    else run<false>(world, parts);
  }

 private:
  template <bool Uniform>
  void run(World<Dim>& world, const SoilParameters& parts) {
    using Pair = StressPair<Dim, Uniform>;
    const Pair pair{soil_kernel(*soil_), parts.first.impedance(), 1 / parts.first.sound_speed,
                    world.parameters().soil.limiter};
    auto& sum_of_forces = soil_->vector(fields::acceleration_sum);
    const auto& x = soil_->vector(fields::position);
    const auto& m = soil_->scalar(fields::mass);
    const auto& volume = soil_->scalar(fields::volume);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = soil_records<T, !Uniform>(world);
      gather<Pair::template Sums>(
          world.list("soil", "soil"), records, records, pair, [&](Index i, const auto& sum) {
            sum_of_forces[i] =
                world.body_acceleration(x[i]) + to_vec(sum.force) * (volume[i] / m[i]);
          });
    });
  }

  bool uniform_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilMomentum> registered_soil_momentum;

}  // namespace
}  // namespace sphgeo
