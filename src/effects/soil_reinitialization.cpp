#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "effects/effect.h"
#include "effects/soil_phase.h"
#include "effects/wall_pair.h"
#include "effects/wall_sets.h"

namespace sphgeo {
namespace {

/// Where the soil's particles lie: number density, and for the transport its gradient and the
/// moment.
template <int Dim, bool Transport>
struct SoilArrangement {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T number{};                                  ///< sum of W V at rest
    LaneVec<Transport ? Dim : 1, T> gradient{};  ///< sum of grad W V
    T divergence{};                              ///< sum of r . grad W V, minus Dim in the bulk
  };

  /// j is soil at rest, or a wall.
  template <class T, class Neighbor>
  void operator()(Sums<T>& sum, const Record<T, packed::RestingSoil<Dim>>&,
                  const Record<T, Neighbor>& j, const LaneVec<Dim, T>& r, const T& r2) const {
    const T volume = j[Neighbor::volume];
    sum.number += kernel.w(r2) * volume;
    if constexpr (Transport) {
      const T slope = kernel.dw_over_r(r2) * volume;
      sum.gradient += slope * r;
      sum.divergence += slope * r2;
    }
  }
};

/// How many neighbors of a particle lie on the free surface.
template <int Dim>
struct NearSurface {
  using Soil = packed::RestingSoil<Dim>;
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T share{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Soil>&, const Record<T, Soil>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    sum.share += kernel.w(r2) * j[Soil::volume] * j[Soil::on_surface];
  }
};

/// Once per advection step: the volume fraction by summation (Algorithm 2, line 11), and for
/// cohesive soil the transport displacement in its original form (Eq. 87).
template <int Dim>
class SoilReinitialization final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {
        "soil_reinitialization", Stage::reinitialize, "Algorithm 2 line 11, Eq. 87",
        "volume fraction of soil by summation; transport displacement when the deck asks for it",
        false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    if (!world.parameters().soil.deformable) return {"no skeleton is deformable"};
    const NumericsParameters& n = world.parameters().numerics;
    if (!n.volume_fraction_by_summation && !n.transport_velocity_soil)
      return {
          "numerics switches off both volume_fraction_reinitialization and "
          "transport_velocity_soil"};
    return {std::make_unique<SoilReinitialization>(world),
            n.transport_velocity_soil ? "there is soil; transport_velocity_soil is asked for"
                                      : "there is soil"};
  }

  explicit SoilReinitialization(const World<Dim>& world)
      : walls_(wall_sets(world)),
        transport_(world.parameters().numerics.transport_velocity_soil),
        sums_(world.parameters().numerics.volume_fraction_by_summation) {}

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::mass, Access::read},
             {"soil", &fields::initial_volume_fraction, Access::read},
             {"soil", &fields::volume_fraction, Access::update}},
            {{"soil", "soil"}}};
    if (sums_) n.fields.push_back({"soil", &fields::number_density_ratio, Access::write});
    if (transport_) {
      n.fields.push_back({"soil", &fields::position, Access::update});
      n.fields.push_back({"soil", &fields::surface, Access::write});
    }
    if (transport_) n.record<Soil>("soil", Access::scratch);
    else n.record<Soil>("soil", Access::scratch, Soil::volume);
    n.record<Position<Dim>>("soil", transport_ ? Access::update : Access::read);
    need_wall_volumes<Dim>(n, "soil", walls_);
    return n;
  }

  void prepare(World<Dim>& world) override {
    soil_ = &world.set("soil");
    lattice_ = lattice_sums(Kernel<Dim>(soil_->smoothing_length()), soil_->spacing()).number;
  }

  void apply(World<Dim>& world) override {
    if (transport_) run<true>(world);
    else run<false>(world);
  }

 private:
  using Soil = packed::RestingSoil<Dim>;
  struct Around {
    double number = 0, divergence = 0;
    Vec<Dim> gradient = Vec<Dim>::Zero();
  };

  template <bool Transport>
  void run(World<Dim>& world) {
    using Pair = SoilArrangement<Dim, Transport>;
    around_.assign(static_cast<std::size_t>(soil_->size()), {});
    const SoilParameters& parts = world.parameters().soil;
    const auto& m = soil_->scalar(fields::mass);
    const auto& n0 = soil_->scalar(fields::initial_volume_fraction);
    const auto& part = soil_->tag(fields::part);
    const auto rest = [&](Index i) { return m[i] / (n0[i] * parts[part[i]].grain_density); };
    const Pair pair{soil_kernel(*soil_)};
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Soil, T>(world, "soil");
      parallel_for(soil_->size(), [&](Index i) { records[i].put(Soil::volume, rest(i)); });
      const auto keep = [&](Index i, const auto& s) {
        Around& a = around_[static_cast<std::size_t>(i)];
        a.number += s.number;
        if constexpr (Transport) {
          a.gradient += to_vec(s.gradient);
          a.divergence += s.divergence;
        }
      };
      gather<Pair::template Sums>(world.list("soil", "soil"), records, records, pair, keep);
      for (const std::string& set : walls_)
        gather<Pair::template Sums>(world.list("soil", set), records,
                                    read_records<packed::Wall<Dim>, T>(world, set), pair, keep);
    });
    if (world.parameters().numerics.volume_fraction_by_summation) {
      auto& n = soil_->scalar(fields::volume_fraction);
      auto& ratio = soil_->scalar(fields::number_density_ratio);
      const double self = Kernel<Dim>(soil_->smoothing_length()).w(0.0);
      // Of the neighborhood, the corner of a block has 1/4 in 2D, 1/8 in 3D.
      const double alone = self * std::pow(soil_->spacing(), Dim) / lattice_,
                   detached = alone + 0.8 / (1 << Dim) * (1 - alone);
      parallel_for(soil_->size(), [&](Index i) {
        ratio[i] = (around_[static_cast<std::size_t>(i)].number + self * rest(i)) / lattice_;
        const double summed = n0[i] * ratio[i];
        // Grains that come apart leave the range of each other's kernels with the volume fraction
        // they had, and would meet at that range again as if they touched. With fewer neighbors
        // than at the corner of a block one is no part of a skeleton any more, and as loose as it
        // looks.
        if (ratio[i] < detached) n[i] = std::min(n[i], summed);
        // A sum that falls short is a surface or a splash: it keeps its volume fraction, up to the
        // factor by which it exceeds that at rest, as the density of water does.
        n[i] = summed + std::max(0.0, n[i] - summed) * n0[i] / n[i];
      });
    }
    if constexpr (Transport) shift(world);
  }

  // Eq. 87 with the sign that leads away from dense regions. Particles whose kernel reaches
  // the free surface stay: there the sum measures the cut kernel, not the arrangement (as for
  // water).
  void shift(World<Dim>& world) {
    const double h = soil_->smoothing_length();
    const double factor = 2 * world.parameters().numerics.transport_coefficient * h * h;
    auto& x = soil_->vector(fields::position);
    auto& surface = soil_->tag(fields::surface);
    const SoilParameters& parts = world.parameters().soil;
    const auto& part = soil_->tag(fields::part);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      const auto records = write_records<Soil, T>(world, "soil");
      parallel_for(soil_->size(), [&](Index i) {
        surface[i] = -around_[static_cast<std::size_t>(i)].divergence < 0.75 * Dim ? 1 : 0;
        records[i].put(Soil::on_surface, surface[i]);
      });
      gather<NearSurface<Dim>::template Sums>(
          world.list("soil", "soil"), records, records, NearSurface<Dim>{Kernel<Dim>(h)},
          [&](Index i, const auto& near) {
            if (surface[i] || near.share > 0 || !parts[part[i]].moves) return;
            x[i] -= factor * around_[static_cast<std::size_t>(i)].gradient;
          });
    });
    world.pack_positions(*soil_);
  }

  std::vector<std::string> walls_;  // sets of walls
  bool transport_, sums_;
  ParticleSet<Dim>* soil_ = nullptr;
  double lattice_ = 1;
  std::vector<Around> around_;
};

const RegisterEffect<SoilReinitialization> registered_soil_reinitialization;

}  // namespace
}  // namespace sphgeo
