#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "effects/effect.h"
#include "effects/lattice_sums.h"
#include "effects/wall_sets.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// The sums that say how the particles lie: number density, its gradient, divergence of position;
/// in soil also the gradient of the water fraction (Eq. 89).
template <int Dim, bool Porous>
struct ArrangementPair {
  using Water = packed::RestingWater<Dim>;
  Kernel<Dim> kernel;

  template <class T>
  struct Clear {
    T number{};                  ///< sum of W V
    LaneVec<Dim, T> gradient{};  ///< sum of grad W V
    T moment[Dim][Dim] = {};     ///< sum of r (x) grad W V
  };
  template <class T>
  struct Pores : Clear<T> {
    LaneVec<Dim, T> fraction{};  ///< q: sum of (n_j - n_i) grad W V
  };
  template <class T>
  struct Sums : std::conditional_t<Porous, Pores<T>, Clear<T>> {};

  /// j is water at rest, or a wall.
  template <class T, class Neighbor>
  void operator()(Sums<T>& sum, const Record<T, Water>& i, const Record<T, Neighbor>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    (void)i;
    const T volume = j[Neighbor::volume];
    const T slope = kernel.dw_over_r(r2) * volume;
    sum.number += kernel.w(r2) * volume;
    if constexpr (Porous) sum.gradient += (slope * j[Water::swelling]) * r;
    else sum.gradient += slope * r;
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) sum.moment[a][b] += slope * r[a] * r[b];
    if constexpr (Porous) sum.fraction += (slope * (j[Water::fraction] - i[Water::fraction])) * r;
  }
};

/// The free surface around a particle: its share of the kernel and its mean normal.
template <int Dim>
struct SurfacePair {
  using Water = packed::RestingWater<Dim>;
  using Surface = packed::FreeSurface<Dim>;
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T share{};
    LaneVec<Dim, T> normal{};
  };

  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Water>&, const Record<T, Water, Surface>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    const T weight = kernel.w(r2) * j[Water::volume];
    sum.share += weight * j[Surface::on_surface];
    sum.normal += weight * j.vec(Surface::normal);
  }
};

template <int Dim>
struct Arrangement {
  double number = 0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> moment = Eigen::Matrix<double, Dim, Dim>::Zero();

  Vec<Dim> fraction = Vec<Dim>::Zero();

  template <class Sums>
  void add(const Sums& s) {
    number += s.number;
    gradient += to_vec(s.gradient);
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) {
        moment(a, b) += s.moment[a][b];
        if (b != a) moment(b, a) += s.moment[a][b];
      }
    if constexpr (requires { s.fraction; }) fraction += to_vec(s.fraction);
  }
};

/// Once per advection step, in one walk over the pairs: the free surface by the divergence of
/// position, the density by summation (Algorithm 2, line 11) and the transport displacement (Eqs.
/// 87, 88).
///
/// In soil every sum is taken with the target volumes m / (rho0 n^w) of Eq. 88. So the density,
/// too, follows from how far the particles are from the spacing that the porosity asks for. The
/// paper's sum of m W, divided by the particle's own n^w, compares a fraction that was smoothed
/// twice with one that was smoothed once: at a step of porosity they differ by several percent,
/// which the equation of state would answer with pressures of several dynamic heads. And in pores
/// the sum is only followed as fast as the water can flow there (see pore_share).
///
/// The gradient of the shift weighs every particle as the pressure force does, with the scale of
/// gradients: so the positions that the shift leads to are those where a constant pressure has no
/// resultant. Where the drag keeps particles from following the sum, it takes the volumes m / (rho
/// n^w) of now. With those at rest (Eq. 88) it works against the compression of water at depth,
/// without end: particles that stay where they are then have a velocity against it, and the drag of
/// fine soil answers to that velocity with more than the weight of the water.
template <int Dim>
class WaterReinitialization final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_reinitialization", Stage::reinitialize, "Algorithm 2 line 11, Eqs. 87-89",
            "free surface, density by summation, transport displacement", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    const NumericsParameters& n = world.parameters().numerics;
    if (n.density_reinitialization != DensityReinitialization::summation && !n.transport_velocity &&
        !volume_follows_porosity(world))
      return {
          "numerics switches off both density_reinitialization by summation and "
          "transport_velocity"};
    return {std::make_unique<WaterReinitialization>(world), "there is water"};
  }

  explicit WaterReinitialization(const World<Dim>& world)
      : walls_(wall_sets(world)),
        porous_(volume_follows_porosity(world)),
        transport_(world.parameters().numerics.transport_velocity) {
    need_volume_share(world, volume_);
    if (!porous_) return;
    volume_.fields.push_back({"water", &fields::gradient_scale, Access::update});
    if (transport_) {
      volume_.fields.push_back({"water", &fields::acceleration, Access::read});
      volume_.fields.push_back({"water", &fields::drag_acceleration, Access::read, true});
    }
    volume_.fields.push_back({"water", &fields::drag_linear, Access::read});
    volume_.fields.push_back({"water", &fields::drag_quadratic, Access::read});
  }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::mass, Access::read},
             {"water", &fields::density, Access::update},
             {"water", &fields::position, Access::update},
             {"water", &fields::surface, Access::write}},
            {{"water", "water"}}};
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    using Water = packed::RestingWater<Dim>;
    if (porous_) n.record<Water>("water", Access::scratch);
    else n.record<Water>("water", Access::scratch, Water::volume);
    n.record<Position<Dim>>("water", transport_ ? Access::update : Access::read);
    if (transport_) n.record<packed::FreeSurface<Dim>>("water", Access::scratch);
    need_wall_volumes<Dim>(n, "water", walls_);
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    const Kernel<Dim> kernel(water_->smoothing_length());
    lattice_ = lattice_sums(kernel, water_->spacing()).number;
    moment_ = lattice_sums(kernel, water_->spacing()).moment;
    if (porous_) spread_ = std::make_unique<SpreadLattice<Dim>>(kernel, water_->spacing());
  }

  void apply(World<Dim>& world) override {
    const NumericsParameters& n = world.parameters().numerics;
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const bool summation = n.density_reinitialization == DensityReinitialization::summation;
      if (porous_) sum_pairs<T, true>(world, summation);
      else sum_pairs<T, false>(world, summation);
      if (transport_) shift<T>(world);
    });
    if (transport_) world.pack_positions(*water_);
  }

 private:
  // Block by block, so that the sums of no more than a block are ever kept.
  template <class T, bool Porous>
  void sum_pairs(World<Dim>& world, bool summation) {
    using Sums = std::array<Arrangement<Dim>, block_size>;
    const double rho0 = world.parameters().water.density;
    const auto& m = water_->scalar(fields::mass);
    const ArrangementPair<Dim, Porous> pair{Kernel<Dim>(water_->smoothing_length())};
    const ArrangementPair<Dim, false> wall_pair{pair.kernel};
    const Field<double>* n = Porous ? volume_share(world) : nullptr;
    const auto at_rest = [&](Index i) { return Porous ? m[i] / (rho0 * (*n)[i]) : m[i] / rho0; };
    auto& rho = water_->scalar(fields::density);
    Field<double>* scale = Porous ? &water_->scalar(fields::gradient_scale) : nullptr;
    const bool by_target = world.parameters().numerics.transport_target_volume;
    using Water = packed::RestingWater<Dim>;
    const auto records = write_records<Water, T>(world, "water");
    // The volume at rest, so that compression does not feed back on the arrangement.
    parallel_for(water_->size(), [&](Index i) {
      const auto record = records[i];
      record.put(Water::volume, at_rest(i));
      if constexpr (Porous) {
        record.put(Water::fraction, (*n)[i]);
        const double before = (*scale)[i] > 0 ? (*scale)[i] : 1;
        const double held = (*n)[i] < 1 ? 1 - pore_share(world, i) : 0;
        record.put(Water::swelling,
                   before * (by_target ? 1 + held * (rho0 / rho[i] - 1) : (*n)[i]));
      }
    });
    const auto walk = [&](const NeighborList& list, const auto& sources, const auto& with_pair,
                          Index b, Sums& sums) {
      gather_block<std::decay_t<decltype(with_pair)>::template Sums>(
          list, b, records, sources, with_pair, [&](Index i, const auto& s) {
            sums[static_cast<std::size_t>(i - b * block_size)].add(s);
          });
    };
    const NeighborList& water = world.list("water", "water");
    using Surface = packed::FreeSurface<Dim>;
    std::optional<RecordPacking<Surface, T>> surfaces;
    if (transport_) surfaces = write_records<Surface, T>(world, "water");
    const double self = pair.kernel.w(0.0), volume_at_dp = std::pow(water_->spacing(), Dim);
    auto& surface = water_->tag(fields::surface);
    parallel_blocks(water_->size(), block_size, [&](Index begin, Index end, Index b) {
      Sums sums;
      walk(water, records, pair, b, sums);
      if constexpr (Porous)  // as a water particle like itself would
        for (Index i = begin; i < end; ++i)
          sums[static_cast<std::size_t>(i - begin)].gradient /= (*scale)[i] > 0 ? (*scale)[i] : 1;
      for (const std::string& set : walls_)
        walk(world.list("water", set), read_records<packed::Wall<Dim>, T>(world, set), wall_pair, b,
             sums);
      for (Index i = begin; i < end; ++i) {
        const Arrangement<Dim>& s = sums[static_cast<std::size_t>(i - begin)];
        // The divergence of position is Dim in the bulk; three quarters of it tell the surface,
        // half of it spray.
        const double filled = -s.moment.trace() / Dim;
        surface[i] = filled < 0.5 ? spray : filled < 0.75 ? 1 : 0;
        double lattice = lattice_;
        if constexpr (Porous) {
          const LatticeSums spread = (*spread_)(volume_at_dp * rho0 * (*n)[i] / m[i]);
          lattice = spread.number;
          (*scale)[i] = (*n)[i] < 1 ? gradient_factor(-s.moment.trace() / Dim, spread.moment) : 1;
        }
        if (summation) {
          const double summed = rho0 * (s.number + self * at_rest(i)) / lattice;
          const bool in_pores = Porous && (*n)[i] < 1;
          // A sum that falls short is a surface or a splash, not a rarefaction: it keeps its
          // density, up to the factor by which rho exceeds rho0.
          const double summed_density = summed + std::max(0.0, rho[i] - summed) * rho0 / rho[i];
          rho[i] = in_pores
                       ? rho[i] + pore_change(pore_share(world, i), summed_density - rho[i], rho0)
                       : summed_density;
          // Negative pressure is cut off at the free surface: an isolated particle would be
          // attracted to the wall.
          if (surface[i]) rho[i] = std::max(rho[i], rho0);
        }
        if (surfaces)
          pack_surface((*surfaces)[i], surface[i] != 0, s,
                       Porous ? projected(world, s) : s.gradient);
      }
    });
  }

  // What the shift needs of one particle.
  template <class T>
  static void pack_surface(const PackedRecord<packed::FreeSurface<Dim>, T>& record, bool surface,
                           const Arrangement<Dim>& s, const Vec<Dim>& gradient) {
    using Surface = packed::FreeSurface<Dim>;
    record.put(Surface::normal, surface ? surface_normal(s) : Vec<Dim>(Vec<Dim>::Zero()));
    record.put(Surface::on_surface, surface ? 1.0 : 0.0);
    record.put(Surface::gradient, gradient);
  }

  // How much of the sum's density a particle in pores takes over. Particles never lie so evenly
  // that their sum says less than some thousandths of a density, a pressure of several heads. In
  // clear water they get out of each other's way at once. In pores the pressure spreads with the
  // diffusivity n^2 rho c^2 / D only, D the drag, and until then the soil feels it. So the share is
  // a thousandth of the times that a smoothing length evens out within the step.
  double pore_share(const World<Dim>& world, Index i) const {
    const double n = water_->scalar(fields::water_fraction)[i],
                 speed = water_->vector(fields::velocity)[i].norm();
    const double drag =
        water_->scalar(fields::drag_linear)[i] + water_->scalar(fields::drag_quadratic)[i] * speed;
    const double evening = n * world.parameters().water.sound_speed / water_->smoothing_length();
    const double steps =
        1e-3 * evening * evening * world.parameters().water.density * world.clock.dt_advection;
    return steps < drag ? steps / drag : 1.0;
  }

  // Where that is little, the errors of a whole layer add up before they drain: there the sum only
  // keeps the density within two percent, and the continuity equation moves it.
  static double pore_change(double share, double difference, double rho0) {
    const double margin = 0.02 * rho0 * (1 - share);
    return share * std::copysign(std::max(0.0, std::abs(difference) - margin), difference);
  }

  // The moment of the particles around says how weak their sums are; where it is cut off at a
  // surface, that of a lattice does.
  double gradient_factor(double moment, double lattice) const {
    const double full = std::clamp((moment / lattice - 0.85) / 0.1, 0.0, 1.0);
    return std::sqrt(moment_ / (full * moment + (1 - full) * lattice));
  }

  // P^p of Eqs. 88 and 89 on the sum of gradients: where the porosity changes within a smoothing
  // length, the spacing changes with it, and the shift would even out what is meant to be uneven.
  Vec<Dim> projected(const World<Dim>& world, const Arrangement<Dim>& s) const {
    const NumericsParameters& n = world.parameters().numerics;
    if (!n.transport_projection ||
        water_->smoothing_length() * s.fraction.norm() <= n.transport_projection_threshold)
      return s.gradient;
    Vec<Dim> normal = s.fraction;
    if (std::abs(s.moment.determinant()) > 1e-3) normal = s.moment.inverse() * s.fraction;
    normal.normalize();
    return s.gradient - normal.dot(s.gradient) * normal;
  }

  // Eq. 87 with the sign that leads away from dense regions. Wherever the kernel reaches
  // the free surface, its truncation looks like a rarefaction, much stronger than any real one. Eq.
  // 87 keeps the part along the surface; as the normal is never exact, what is left stirs still
  // water (kinetic energy three times as high, 15 spacings deep in 3D), so the default leaves these
  // particles alone.
  template <class T>
  void shift(World<Dim>& world) {
    using Pair = SurfacePair<Dim>;
    const double h = water_->smoothing_length();
    const double factor = 2 * world.parameters().numerics.transport_coefficient * h * h;
    const bool tangential =
        world.parameters().numerics.transport_at_surface == SurfaceTransport::tangential;
    auto& x = water_->vector(fields::position);
    const Field<double>* share = volume_share(world);
    const Field<Vec<Dim>>* a = porous_ ? &water_->vector(fields::acceleration) : nullptr;
    const Field<Vec<Dim>>* drag = water_->has(fields::drag_acceleration)
                                      ? &water_->vector(fields::drag_acceleration)
                                      : nullptr;
    auto& rho = water_->scalar(fields::density);
    const double sound = world.parameters().water.sound_speed;
    using Surface = packed::FreeSurface<Dim>;
    const auto first = read_records<packed::RestingWater<Dim>, T>(world, "water");
    const auto second = read_records<Surface, T>(world, "water");
    gather<Pair::template Sums>(world.list("water", "water"), first, with(first, second),
                                Pair{Kernel<Dim>(h)}, [&](Index i, const auto& near) {
                                  const bool surface = second.get(i, Surface::on_surface) > 0;
                                  Vec<Dim> move, normal;
                                  for (int k = 0; k < Dim; ++k) {
                                    move[k] = -factor * second.get(i, Surface::gradient, k);
                                    normal[k] = second.get(i, Surface::normal, k);
                                  }
                                  if (surface || near.share > 0) {
                                    if (!tangential) return;
                                    // The list leaves the particle itself out.
                                    const double weight = near.share + (surface ? 1.0 : 0.0);
                                    const Vec<Dim> mean = to_vec(near.normal) + normal;
                                    // Surfaces that face each other, as of a thin film or an
                                    // isolated particle, leave no direction along which anything
                                    // may move.
                                    const double length = mean.norm();
                                    if (length < 0.5 * weight) return;
                                    move -= (mean.dot(move) / (length * length)) * mean;
                                  }
                                  x[i] += move;
                                  if (share && (*share)[i] < 1) {
                                    // It comes to another pressure, grad p = rho (g - dv/dt +
                                    // drag), and takes it over. Were it to keep its own, it would
                                    // flow back, for ever, and the soil would feel the drag of that
                                    // flow.
                                    Vec<Dim> gradient = world.body_acceleration(x[i]) - (*a)[i];
                                    if (drag) gradient += (*drag)[i];
                                    rho[i] += rho[i] * gradient.dot(move) / (sound * sound);
                                  }
                                });
  }

  // Outward normal of the free surface at one particle, corrected for the disorder around it; zero
  // for a particle that has too few neighbors to tell.
  static Vec<Dim> surface_normal(const Arrangement<Dim>& s) {
    if (std::abs(s.moment.determinant()) < 1e-3) return Vec<Dim>::Zero();
    return (s.moment.inverse() * s.gradient).normalized();
  }

  std::vector<std::string> walls_;  // sets of walls
  bool porous_, transport_;
  Needs volume_;  // what the target volume needs beside the mass
  std::unique_ptr<SpreadLattice<Dim>> spread_;
  ParticleSet<Dim>* water_ = nullptr;
  double lattice_ = 1, moment_ = 1;
};

const RegisterEffect<WaterReinitialization> registered_water_reinitialization;

}  // namespace
}  // namespace sphgeo
