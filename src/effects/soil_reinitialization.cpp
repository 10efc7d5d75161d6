#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "effects/effect.h"
#include "effects/soil_phase.h"
#include "effects/wall_pair.h"

namespace sphgeo {
namespace {

/// Where the soil's particles lie: number density and its gradient, and for the transport the moment.
template <int Dim, bool Transport>
struct SoilArrangement {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T number{};                  ///< sum of W V at rest
    LaneVec<Dim, T> gradient{};  ///< sum of grad W V
    T divergence{};              ///< sum of r . grad W V, minus Dim in the bulk
  };

  template <class T, int N, int M>
  void operator()(Sums<T>& sum, const Record<Dim, T, N>&, const Record<Dim, T, M>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T volume = j[soil_slot::volume];
    sum.number += kernel.w(r2) * volume;
    const T slope = kernel.dw_over_r(r2) * volume;
    sum.gradient += slope * r;
    if constexpr (Transport) sum.divergence += slope * r2;
  }
};

/// What a free surface takes from the sum of W V, per gradient of that sum [m]: of the first layer of a lattice. With it the sum tells how
/// closely particles are packed also at a surface: within 3 % on a plane one, loose or dense, and on two layers; 15 % too little on an edge of 90 degrees.
template <int Dim>
double missing_per_gradient(const Kernel<Dim>& kernel, double dp) {
  const int reach = static_cast<int>(std::ceil(kernel.support() / dp)), reach_y = Dim == 3 ? reach : 0;
  double missing = 0, gradient = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach_y; j <= reach_y; ++j)
      for (int k = 1; k <= reach; ++k) {
        const double r2 = dp * dp * (i * i + j * j + k * k);
        missing += kernel.w(r2);
        gradient -= kernel.dw_over_r(r2) * dp * k;
      }
  return missing / gradient;
}

/// How many neighbors of a particle lie on the free surface.
template <int Dim>
struct NearSurface {
  Kernel<Dim> kernel;
  template <class T>
  struct Sums {
    T share{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T>&, const Record<Dim, T>& j, const LaneVec<Dim, T>&, const T& r2) const {
    sum.share += kernel.w(r2) * j[soil_slot::volume] * j[soil_slot::scratch];
  }
};

/// Once per advection step: the volume fraction by summation (Algorithm 2, line 11), and for cohesive
/// soil the transport displacement in its original form (Eq. 87).
template <int Dim>
class SoilReinitialization final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"soil_reinitialization", Stage::reinitialize, "Algorithm 2 line 11, Eq. 87",
            "volume fraction of soil by summation; transport displacement when the deck asks for it", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("soil")) return {"there is no soil"};
    if (!SoilParts(world).deformable) return {"no skeleton is deformable"};
    const Numerics& n = world.model().numerics;
    if (n.volume_fraction_reinitialization == "none" && !n.transport_velocity_soil)
      return {"numerics switches off both volume_fraction_reinitialization and transport_velocity_soil"};
    return {std::make_unique<SoilReinitialization>(world),
            n.transport_velocity_soil ? "there is soil; transport_velocity_soil is asked for" : "there is soil"};
  }

  explicit SoilReinitialization(const World<Dim>& world)
      : has_walls_(world.find("walls") != nullptr), transport_(world.model().numerics.transport_velocity_soil),
        sums_(world.model().numerics.volume_fraction_reinitialization == "summation") {}

  std::string acts_on() const override { return "soil"; }
  Needs needs() const override {
    Needs n{{{"soil", &fields::mass, Access::read},
             {"soil", &fields::initial_volume_fraction, Access::read},
             {"soil", &fields::volume_fraction, Access::update}},
            {{"soil", "soil"}}};
    if (sums_) n.fields.push_back({"soil", &fields::crowding, Access::write});
    if (transport_) {
      n.fields.push_back({"soil", &fields::position, Access::update});
      n.fields.push_back({"soil", &fields::surface, Access::write});
    }
    if (has_walls_) {
      n.fields.push_back({"walls", &fields::volume, Access::read});
      n.lists.push_back({"soil", "walls"});
    }
    return n;
  }

  void prepare(World<Dim>& world) override {
    soil_ = &world.set("soil");
    lattice_ = lattice_sums(Kernel<Dim>(soil_->smoothing_length()), soil_->spacing()).number;
    per_gradient_ = missing_per_gradient(soil_kernel(*soil_), soil_->spacing());
  }

  void apply(World<Dim>& world) override {
    if (transport_) run<true>(world);
    else run<false>(world);
  }

 private:
  struct Around {
    double number = 0, divergence = 0;
    Vec<Dim> gradient = Vec<Dim>::Zero();
  };

  template <bool Transport>
  void run(World<Dim>& world) {
    using Pair = SoilArrangement<Dim, Transport>;
    around_.assign(static_cast<std::size_t>(soil_->size()), {});
    const SoilParts parts(world);
    const auto& m = soil_->scalar(fields::mass);
    const auto& n0 = soil_->scalar(fields::initial_volume_fraction);
    const auto& part = soil_->tag(fields::part);
    const auto rest = [&](Index i) { return m[i] / (n0[i] * parts[part[i]].grain_density); };
    const Pair pair{soil_kernel(*soil_)};
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& records = world.records("soil").template get<T>();
      parallel_for(soil_->size(), [&](Index i) { records[i][soil_slot::volume] = static_cast<T>(rest(i)); });
      const auto keep = [&](Index i, const auto& s) {
        Around& a = around_[static_cast<std::size_t>(i)];
        a.number += s.number;
        a.gradient += to_vec(s.gradient);
        if constexpr (Transport) a.divergence += s.divergence;
      };
      gather<Pair::template Sums>(world.list("soil", "soil"), records, records, pair, keep);
      if (has_walls_)
        gather<Pair::template Sums>(world.list("soil", "walls"), records, world.records("walls").template get<T>(), pair, keep);
    });
    if (world.model().numerics.volume_fraction_reinitialization == "summation") {
      auto& n = soil_->scalar(fields::volume_fraction);
      auto& crowding = soil_->scalar(fields::crowding);
      const double self = Kernel<Dim>(soil_->smoothing_length()).w(0.0);
      parallel_for(soil_->size(), [&](Index i) {
        const Around& a = around_[static_cast<std::size_t>(i)];
        const double sum = (a.number + self * rest(i)) / lattice_;
        crowding[i] = std::max(sum, std::min(1.0, sum + per_gradient_ * a.gradient.norm() / lattice_));
        const double summed = n0[i] * sum;
        // A sum that falls short is a surface or a splash: it keeps its volume fraction, up to the factor
        // by which it exceeds that at rest, as the density of water does.
        n[i] = summed + std::max(0.0, n[i] - summed) * n0[i] / n[i];
      });
    }
    if constexpr (Transport) shift(world);
  }

  // Eq. 87 with the sign that leads away from crowded places. Particles whose kernel reaches the free
  // surface stay: there the sum measures the cut kernel, not the arrangement (as for water).
  void shift(World<Dim>& world) {
    const double h = soil_->smoothing_length();
    const double factor = 2 * world.model().numerics.transport_coefficient * h * h;
    auto& x = soil_->vector(fields::position);
    auto& surface = soil_->tag(fields::surface);
    const SoilParts parts(world);
    const auto& part = soil_->tag(fields::part);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& records = world.records("soil").template get<T>();
      parallel_for(soil_->size(), [&](Index i) {
        surface[i] = -around_[static_cast<std::size_t>(i)].divergence < 0.75 * Dim ? 1 : 0;
        records[i][soil_slot::scratch] = static_cast<T>(surface[i]);  // until predict packs again
      });
      gather<NearSurface<Dim>::template Sums>(
          world.list("soil", "soil"), records, records, NearSurface<Dim>{Kernel<Dim>(h)}, [&](Index i, const auto& near) {
            if (surface[i] || near.share > 0 || !parts[part[i]].moves) return;
            x[i] -= factor * around_[static_cast<std::size_t>(i)].gradient;
          });
    });
    world.pack_positions(*soil_);
  }

  bool has_walls_, transport_, sums_;
  ParticleSet<Dim>* soil_ = nullptr;
  double lattice_ = 1, per_gradient_ = 0;
  std::vector<Around> around_;
};

const RegisterEffect<SoilReinitialization> registered;

}  // namespace
}  // namespace sphgeo
