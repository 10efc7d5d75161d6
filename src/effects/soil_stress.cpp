#include <array>
#include <cmath>

#include "effects/effect.h"
#include "effects/soil_wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Velocity gradient, and the moment that corrects it.
template <int Dim>
struct GradientSums {
  template <class T>
  struct Sums {
    T gradient[Dim][Dim] = {};           ///< sum of (v_j - v_i) (x) grad W V
    T moment[Dim * (Dim + 1) / 2] = {};  ///< sum of (r_j - r_i) (x) grad W V, upper half by rows
  };

  template <class T>
  static void add(Sums<T>& sum, const LaneVec<Dim, T>& dv, const LaneVec<Dim, T>& r,
                  const T& gradient) {
    const LaneVec<Dim, T> slope = gradient * r;
    int m = 0;
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) sum.gradient[a][b] += dv[a] * slope[b];
      for (int b = a; b < Dim; ++b) sum.moment[m++] -= r[a] * slope[b];
    }
  }
};

template <int Dim>
struct GradientPair {
  using Soil = packed::SoilState<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  void operator()(typename GradientSums<Dim>::template Sums<T>& sum, const Record<T, Soil>& i,
                  const Record<T, Soil>& j, const LaneVec<Dim, T>& r, const T& r2) const {
    const T gradient = kernel.dw_over_r(r2) * j[Soil::volume];
    GradientSums<Dim>::add(sum, j.vec(Soil::velocity) - i.vec(Soil::velocity), r, gradient);
  }
};

template <int Dim>
struct WallGradientPair {
  SoilWallPair<Dim> wall;
  template <class T>
  void operator()(typename GradientSums<Dim>::template Sums<T>& sum,
                  const Record<T, packed::SoilState<Dim>>& i, const WallRecord<Dim, T>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    // Mirrored velocities tell how the velocity changes across the wall, and nothing of how it
    // changes along it, which would count as no change at all if the whole of r were used here.
    const LaneVec<Dim, T> n = j.vec(packed::WallSurface<Dim>::normal);
    const T r_n = dot(r, n);
    GradientSums<Dim>::add(sum, SoilWallPair<Dim>::mirrored(i, j), r_n * n, wall.slope(j, r_n, r2));
  }
};

/// Stress of all soil particles over one step (Algorithm 1), after the velocity gradient (Eq. 55)
/// and the rate of the volume fraction (Eq. 48), block by block.
template <int Dim>
class SoilStress final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_stress", Stage::rate, "Eqs. 15-21, 48, 55",
            "velocity gradient, stress and rate of the volume fraction of soil", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    if (!world.parameters().soil.any_moves) return {"every skeleton is fixed"};
    return {std::make_unique<SoilStress>(world), "there is soil that moves"};
  }

  explicit SoilStress(const World<Dim>& world)
      : walls_(wall_sets(world)),
        wetted_(world.set("soil").has(fields::saturation)),
        follows_number_density_(world.parameters().soil.deformable &&
                                world.parameters().numerics.volume_fraction_by_summation) {}

  std::string acts_on() const override {
    return !walls_.empty() ? "soil, also near walls" : "soil";
  }
  Needs needs() const override {
    Needs n{{{"soil", &fields::volume, Access::read},
             {"soil", &fields::volume_fraction, Access::read},
             {"soil", &fields::initial_volume_fraction, Access::read},
             {"soil", &fields::velocity, Access::read},
             {"soil", &fields::stress, Access::update},
             {"soil", &fields::gradient_correction, Access::write},
             {"soil", &fields::plastic_strain, Access::update},
             {"soil", &fields::plastic_work, Access::update},
             {"soil", &fields::volume_fraction_rate, Access::write}},
            {{"soil", "soil"}}};
    if (follows_number_density_)
      n.fields.push_back({"soil", &fields::number_density_ratio, Access::read});
    if (wetted_) n.fields.push_back({"soil", &fields::saturation, Access::read});
    n.record<Position<Dim>>("soil", Access::read);
    n.record<Soil>("soil", Access::read, Soil::volume, Soil::velocity);
    for (const std::string& set : walls_) {
      need_wall_records<Dim>(n, set);
      n.lists.push_back({"soil", set});
    }
    return n;
  }
  void prepare(World<Dim>& world) override { soil_ = &world.set("soil"); }

  void apply(World<Dim>& world) override {
    world.with_pair_precision([&](auto number) { run<decltype(number)>(world); });
  }

 private:
  using Sums = typename GradientSums<Dim>::template Sums<double>;
  using L = Lanes<double>;
  using Soil = packed::SoilState<Dim>;

  template <class T>
  void run(World<Dim>& world) {
    const Kernel<Dim> kernel = soil_kernel(*soil_);
    const SoilParameters& parts = world.parameters().soil;
    const auto records = read_records<Soil, T>(world, "soil");
    const NeighborList& soil_list = world.list("soil", "soil");
    parallel_blocks(soil_->size(), block_size, [&](Index first, Index end, Index b) {
      std::array<Sums, block_size> sums{};
      const auto at = [&](Index i) -> Sums& { return sums[static_cast<std::size_t>(i - first)]; };
      gather_block<GradientSums<Dim>::template Sums>(soil_list, b, records, records,
                                                     GradientPair<Dim>{kernel},
                                                     [&](Index i, const Sums& s) { at(i) = s; });
      for (const std::string& set : walls_)
        gather_block<GradientSums<Dim>::template Sums>(
            world.list("soil", set), b, records, wall_records<T>(world, set),
            WallGradientPair<Dim>{SoilWallPair<Dim>(world, *soil_)},
            [&](Index i, const Sums& s) { add(at(i), s); });
      finish_block(world, parts, sums.data(), first, end - first);
    });
  }

  static void add(Sums& to, const Sums& s) {
    for (int a = 0; a < Dim; ++a)
      for (int c = 0; c < Dim; ++c) to.gradient[a][c] += s.gradient[a][c];
    for (int m = 0; m < Dim * (Dim + 1) / 2; ++m) to.moment[m] += s.moment[m];
  }

  // The constitutive step of particles first ... first + count - 1, as many at once as there are
  // lanes.
  void finish_block(World<Dim>& world, const SoilParameters& parts, const Sums* sums, Index first,
                    Index count) {
    const double dt = world.clock.dt_acoustic;
    // Soil that is packed closer than it was at t = 0, more than its pressure tells, meets the
    // missing compression over the time in which sound passes 20 smoothing lengths. The rates alone
    // lose sight of it: they see the smooth part of the motion, and sand that has flowed would end
    // 20 to 40 % denser than it started. Margin and time are chosen: slow against sound, fast
    // against the flow.
    const Field<double>* number_density_ratio =
        follows_number_density_ ? &soil_->scalar(fields::number_density_ratio) : nullptr;
    const double per_time = parts.fastest / (20 * soil_->smoothing_length());
    const bool corrected =
        world.parameters().numerics.soil_velocity_gradient == VelocityGradient::corrected;
    auto& stress = soil_->tensor(fields::stress);
    auto& correction = soil_->tensor(fields::gradient_correction);
    auto& strain = soil_->scalar(fields::plastic_strain);
    auto& work = soil_->scalar(fields::plastic_work);
    auto& rate = soil_->scalar(fields::volume_fraction_rate);
    const auto& volume = soil_->scalar(fields::volume);
    const auto& n = soil_->scalar(fields::volume_fraction);
    const auto& n0 = soil_->scalar(fields::initial_volume_fraction);
    const auto& part = soil_->tag(fields::part);
    for (Index k = 0; k < count; k += L::width) {
      const int lanes = static_cast<int>(std::min<Index>(L::width, count - k));
      // Idle lanes of the last group repeat its last particle.
      const auto of = [&](int lane) { return k + std::min(lane, lanes - 1); };
      L sum[Dim][Dim], moment[Dim * (Dim + 1) / 2], s[6];
      DruckerPrager<L> m;
      for (int lane = 0; lane < L::width; ++lane) {
        const Sums& from = sums[of(lane)];
        const Index i = first + of(lane);
        for (int a = 0; a < Dim; ++a)
          for (int c = 0; c < Dim; ++c) sum[a][c].raw[lane] = from.gradient[a][c];
        for (int c = 0; c < Dim * (Dim + 1) / 2; ++c) moment[c].raw[lane] = from.moment[c];
        for (int c = 0; c < 6; ++c) s[c].raw[lane] = stress[i][c];
        DruckerPrager<double> soil = stress_point(parts[part[i]].constants);
        if (wetted_)  // Eq. 108: the strength falls with the cohesion
          soil = with_strength(soil,
                               soil.strength + soil_->scalar(fields::saturation)[i] *
                                                   (parts[part[i]].wet_strength - soil.strength));
        m.bulk.raw[lane] = soil.bulk;
        m.shear.raw[lane] = soil.shear;
        m.friction.raw[lane] = soil.friction;
        m.dilation.raw[lane] = soil.dilation;
        m.strength.raw[lane] = soil.strength;
        m.apex.raw[lane] = soil.apex;
      }
      L gradient[3][3];
      InverseMoment<Dim, L> inverse(moment);
      if (!corrected) inverse.reset();
      correct(sum, inverse, gradient);
      L rates[6];
      symmetric_part(gradient, rates);
      if (number_density_ratio) {
        L excess;
        for (int lane = 0; lane < L::width; ++lane)
          excess.raw[lane] = (*number_density_ratio)[first + of(lane)] - (1 + disorder_margin);
        excess = max(L(0.0), excess + (s[0] + s[1] + s[2]) / (L(3.0) * m.bulk));
        for (int a = 0; a < 3; ++a) gradient[a][a] -= L(per_time / 3) * excess;
      }
      const PlasticStep<L> plastic = update_stress(s, gradient, L(dt), m);
      for (int lane = 0; lane < lanes; ++lane) {
        const Index i = first + k + lane;
        // What has come apart (see SoilReinitialization) bears nothing until it is packed again.
        const bool bears = n[i] > loose * n0[i];
        for (int c = 0; c < 6; ++c) stress[i][c] = bears ? s[c][lane] : 0.0;
        for (int a = 0; a < Dim; ++a)
          for (int c = a; c < Dim; ++c)
            correction[i][tensor_index<Dim>[a][c]] = inverse.entry[a][c][lane];
        strain[i] += plastic.strain[lane];
        work[i] += plastic.work[lane] * volume[i];
        // Eq. 8 with the divergence that the stress sees, so that n^s and stress tell of the same
        // deformation. Eq. 48 adds a part (U* - mean U) that follows the difference of pressures;
        // as the pressure of soil does not follow n^s, nothing would ever balance it, and soil
        // under its own weight would grow denser without end.
        rate[i] = -n[i] * (rates[0][lane] + rates[1][lane] + rates[2][lane]);
      }
    }
  }

  // The x-z plane, or all of space, in three dimensions.
  static void embed(const L (&a)[Dim][Dim], L (&gradient)[3][3]) {
    for (auto& row : gradient)
      for (L& g : row) g = L(0.0);
    constexpr int axis[3] = {0, Dim == 3 ? 1 : 2, 2};
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) gradient[axis[i]][axis[j]] = a[i][j];
  }

  // sum . moment^-1: exact for linear velocities.
  static void correct(const L (&a)[Dim][Dim], const InverseMoment<Dim, L>& inverse,
                      L (&gradient)[3][3]) {
    L product[Dim][Dim];
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        product[i][j] = a[i][0] * inverse.entry[0][j];
        for (int k = 1; k < Dim; ++k) product[i][j] += a[i][k] * inverse.entry[k][j];
      }
    embed(product, gradient);
  }

  // Share of the volume fraction at t = 0 below which soil bears nothing. Flowing sand keeps above
  // 0.9 of it.
  static constexpr double loose = 0.6;
  // Of the sum over neighbors, by disorder alone.
  static constexpr double disorder_margin = 0.05;

  std::vector<std::string> walls_;  // sets of walls
  bool wetted_, follows_number_density_;
  ParticleSet<Dim>* soil_ = nullptr;
};

const RegisterEffect<SoilStress> registered_soil_stress;

}  // namespace
}  // namespace sphgeo
