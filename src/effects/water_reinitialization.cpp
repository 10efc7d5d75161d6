#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "effects/effect.h"
#include "effects/lattice_sums.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// The sums that say how the particles lie: number density, its gradient, divergence of position.
template <int Dim>
struct ArrangementPair {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T number{};                    ///< sum of W V
    LaneVec<Dim, T> gradient{};    ///< sum of grad W V
    T moment[Dim][Dim] = {};       ///< sum of r (x) grad W V
  };

  template <class T, int N, int M>
  void operator()(Sums<T>& sum, const Record<Dim, T, N>&, const Record<Dim, T, M>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T volume = j[water_slot::volume];
    const T slope = kernel.dw_over_r(r2) * volume;
    sum.number += kernel.w(r2) * volume;
    sum.gradient += slope * r;
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) sum.moment[a][b] += slope * r[a] * r[b];
  }
};

/// The free surface around a particle: its share of the kernel and its mean normal.
template <int Dim>
struct SurfacePair {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    T share{};
    LaneVec<Dim, T> normal{};
  };

  template <class T>
  void operator()(Sums<T>& sum, const Record<Dim, T>&, const Record<Dim, T, 2>& j,
                  const LaneVec<Dim, T>&, const T& r2) const {
    const T weight = kernel.w(r2) * j[water_slot::volume];
    sum.share += weight * j[on_surface];
    sum.normal += weight * j.vec(surface_normal);
  }
  // Slots of the water's second record while this pass runs.
  static constexpr int surface_normal = 8;
  static constexpr int on_surface = 12;
};

template <int Dim>
struct Arrangement {
  double number;
  Vec<Dim> gradient;
  Eigen::Matrix<double, Dim, Dim> moment;

  void add(const typename ArrangementPair<Dim>::template Sums<double>& s) {
    number += s.number;
    gradient += to_vec(s.gradient);
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) {
        moment(a, b) += s.moment[a][b];
        if (b != a) moment(b, a) += s.moment[a][b];
      }
  }
};

/// Once per advection step, in one walk over the pairs: the free surface by the divergence of
/// position, the density by summation (Algorithm 2, line 11) and the transport displacement (Eq. 87).
template <int Dim>
class WaterReinitialization final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"water_reinitialization", Stage::reinitialize, "Algorithm 2 line 11, Eq. 87",
            "free surface, density by summation, transport displacement", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    const Numerics& n = world.model().numerics;
    if (n.density_reinitialization == "none" && !n.transport_velocity)
      return {"numerics switches off both density_reinitialization and transport_velocity"};
    return {std::make_unique<WaterReinitialization>(world.find("walls") != nullptr), "there is water"};
  }

  explicit WaterReinitialization(bool walls) : has_walls_(walls) {}

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::mass, Access::read},
             {"water", &fields::density, Access::update},
             {"water", &fields::position, Access::update},
             {"water", &fields::surface, Access::write}},
            {{"water", "water"}}};
    if (has_walls_) {
      n.fields.push_back({"walls", &fields::volume, Access::read});
      n.lists.push_back({"water", "walls"});
    }
    return n;
  }

  void prepare(World<Dim>& world) override {
    water_ = &world.set("water");
    if (world.model().numerics.transport_velocity) world.records("water", 1);
    lattice_ = lattice_sums(Kernel<Dim>(water_->smoothing_length()), water_->spacing()).number;
  }

  void apply(World<Dim>& world) override {
    sums_.assign(static_cast<std::size_t>(water_->size()),
                 {0, Vec<Dim>::Zero(), Eigen::Matrix<double, Dim, Dim>::Zero()});
    sum_pairs(world);
    update(world);
    if (world.model().numerics.transport_velocity) world.pack_positions(*water_);
  }

 private:
  void sum_pairs(World<Dim>& world) {
    const double rho0 = water_->constant("density");
    const auto& m = water_->scalar(fields::mass);
    const ArrangementPair<Dim> pair{Kernel<Dim>(water_->smoothing_length())};
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      using Pair = ArrangementPair<Dim>;
      auto& records = world.records("water").template get<T>();
      // The volume at rest, so that compression does not feed back on the arrangement.
      parallel_for(water_->size(), [&](Index i) {
        records[i][water_slot::volume] = static_cast<T>(m[i] / rho0);
      });
      const auto keep = [&](Index i, const auto& s) { sums_[static_cast<std::size_t>(i)].add(s); };
      gather<Pair::template Sums>(world.list("water", "water"), records, records, pair, keep);
      if (has_walls_)
        gather<Pair::template Sums>(world.list("water", "walls"), records,
                                    world.records("walls").template get<T>(), pair, keep);
    });
  }

  void update(World<Dim>& world) {
    const Numerics& n = world.model().numerics;
    const double rho0 = water_->constant("density");
    const double h = water_->smoothing_length();
    const double self = Kernel<Dim>(h).w(0.0);
    const bool summation = n.density_reinitialization == "summation";
    auto& rho = water_->scalar(fields::density);
    auto& surface = water_->tag(fields::surface);
    const auto& m = water_->scalar(fields::mass);
    parallel_for(water_->size(), [&](Index i) {
      const Arrangement<Dim>& s = sums_[static_cast<std::size_t>(i)];
      // The divergence of position is Dim in the bulk; three quarters of it tell the surface.
      surface[i] = -s.moment.trace() < 0.75 * Dim ? 1 : 0;
      if (!summation) return;
      const double summed = rho0 * (s.number + self * m[i] / rho0) / lattice_;
      // A sum that falls short is a surface or a splash, not a rarefaction: it keeps its density,
      // up to the factor by which rho exceeds rho0.
      rho[i] = summed + std::max(0.0, rho[i] - summed) * rho0 / rho[i];
    });
    if (n.transport_velocity) shift(world);
  }

  // Eq. 87 with the sign that leads away from crowded places. Wherever the kernel reaches the free
  // surface, its truncation looks like a rarefaction, much stronger than any real one. Eq. 87 keeps the
  // part along the surface; as the normal is never exact, what is left stirs still water (kinetic energy
  // three times as high, 15 spacings deep in 3D), so the default leaves these particles alone.
  void shift(World<Dim>& world) {
    using Pair = SurfacePair<Dim>;
    const double h = water_->smoothing_length();
    const double factor = 2 * world.model().numerics.transport_coefficient * h * h;
    const bool tangential = world.model().numerics.transport_at_surface == "tangential";
    auto& x = water_->vector(fields::position);
    const auto& surface = water_->tag(fields::surface);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      auto& first = world.records("water", 0).template get<T>();
      auto& second = world.records("water", 1).template get<T>();
      parallel_for(water_->size(), [&](Index i) {
        T* slot = second[i] - record_size;
        const Vec<Dim> normal = surface[i] ? surface_normal(sums_[static_cast<std::size_t>(i)]) : Vec<Dim>::Zero();
        slot[Pair::on_surface] = static_cast<T>(surface[i]);
        for (int k = 0; k < Dim; ++k) slot[Pair::surface_normal + k] = static_cast<T>(normal[k]);
      });
      gather<Pair::template Sums>(
          world.list("water", "water"), first, with(first, second), Pair{Kernel<Dim>(h)},
          [&](Index i, const auto& near) {
            const Arrangement<Dim>& s = sums_[static_cast<std::size_t>(i)];
            Vec<Dim> move = -factor * s.gradient;
            if (surface[i] || near.share > 0) {
              if (!tangential) return;
              const double own = surface[i] ? 1.0 : 0.0;  // the list leaves the particle itself out
              const Vec<Dim> mean = to_vec(near.normal) + (surface[i] ? surface_normal(s) : Vec<Dim>::Zero());
              // Surfaces that face each other, as of a thin film or a lonely particle, leave no
              // direction along which anything may move.
              const double length = mean.norm();
              if (length < 0.5 * (near.share + own)) return;
              const Vec<Dim> normal = mean / length;
              move -= normal.dot(move) * normal;
            }
            x[i] += move;
          });
    });
  }

  // Outward normal of the free surface at one particle, corrected for the disorder around it; zero
  // for a particle that has too few neighbors to tell.
  static Vec<Dim> surface_normal(const Arrangement<Dim>& s) {
    if (std::abs(s.moment.determinant()) < 1e-3) return Vec<Dim>::Zero();
    return (s.moment.inverse() * s.gradient).normalized();
  }

  bool has_walls_;
  ParticleSet<Dim>* water_ = nullptr;
  double lattice_ = 1;
  std::vector<Arrangement<Dim>> sums_;
};

const RegisterEffect<WaterReinitialization> registered;

}  // namespace
}  // namespace sphgeo
