#include <Eigen/LU>
#include <cmath>

#include "effects/effect.h"
#include "effects/water_phase.h"

namespace sphgeo {
namespace {

/// Moments of the kernel and of the density under it, with p = (1, r / h).
template <int Dim>
struct FilterPair {
  using Filtered = packed::DensityDeviation<Dim>;
  Kernel<Dim> kernel;
  double per_h;

  template <class T>
  struct Sums {
    T moment[(Dim + 1) * (Dim + 2) / 2] = {};  ///< sum of p (x) p W V, upper half by rows
    T density[Dim + 1] = {};                   ///< sum of p (rho / rho0 - 1) W V
  };

  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Filtered>&, const Record<T, Filtered>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    const T w = kernel.w(r2) * j[Filtered::volume];
    T p[Dim + 1];
    p[0] = T(1);
    for (int k = 0; k < Dim; ++k) p[k + 1] = T(-per_h) * r[k];
    int m = 0;
    for (int a = 0; a <= Dim; ++a) {
      for (int b = a; b <= Dim; ++b) sum.moment[m++] += w * p[a] * p[b];
      sum.density[a] += w * p[a] * j[Filtered::deviation];
    }
  }
};

/// Density by a first-order consistent Shepard filter (ref. 36 of the paper): the value at the
/// particle of the linear function that fits the densities around best. It keeps a hydrostatic
/// density to round-off also at walls and surfaces, and smooths the rest.
template <int Dim>
class DensityFilter final : public Effect<Dim> {
 public:
  static EffectInfo info() {
    return {"density_filter", Stage::reinitialize, "section 4.2, ref. 36",
            "density by a corrected (first-order consistent) Shepard filter", false};
  }
  static Binding<Dim> bind(const World<Dim>& world) {
    if (!world.find("water")) return {"there is no water"};
    if (world.parameters().numerics.density_reinitialization != DensityReinitialization::shepard)
      return {"numerics.density_reinitialization is not shepard"};
    return {std::make_unique<DensityFilter>(world), "numerics.density_reinitialization is shepard"};
  }

  explicit DensityFilter(const World<Dim>& world) { need_volume_share(world, volume_); }

  std::string acts_on() const override { return "water"; }
  Needs needs() const override {
    Needs n{{{"water", &fields::mass, Access::read}, {"water", &fields::density, Access::update}},
            {{"water", "water"}}};
    n.fields.insert(n.fields.end(), volume_.fields.begin(), volume_.fields.end());
    n.record<packed::DensityDeviation<Dim>>("water", Access::scratch);
    n.record<Position<Dim>>("water", Access::previous);  // before particles are shifted
    return n;
  }

  void prepare(World<Dim>& world) override { water_ = &world.set("water"); }

  void apply(World<Dim>& world) override {
    using Matrix = Eigen::Matrix<double, Dim + 1, Dim + 1>;
    const double h = water_->smoothing_length(), rho0 = world.parameters().water.density;
    const FilterPair<Dim> pair{Kernel<Dim>(h), 1 / h};
    const auto& m = water_->scalar(fields::mass);
    auto& rho = water_->scalar(fields::density);
    const Field<double>* share = volume_share(world);
    world.with_pair_precision([&](auto number) {
      using T = decltype(number);
      using Filtered = packed::DensityDeviation<Dim>;
      const auto records = write_records<Filtered, T>(world, "water");
      const auto volume = [&](Index i) { return m[i] / (share ? (*share)[i] * rho[i] : rho[i]); };
      parallel_for(water_->size(), [&](Index i) {
        records[i].put(Filtered::volume, volume(i));
        records[i].put(Filtered::deviation, rho[i] / rho0 - 1);
      });
      // The pass reads densities from the records, so each may be written as it is found.
      gather<FilterPair<Dim>::template Sums>(
          world.list("water", "water"), records, records, pair, [&](Index i, const auto& s) {
            Matrix a;
            Eigen::Matrix<double, Dim + 1, 1> b;
            int k = 0;
            for (int r = 0; r <= Dim; ++r) {
              for (int c = r; c <= Dim; ++c) a(r, c) = a(c, r) = s.moment[k++];
              b[r] = s.density[r];
            }
            const double self = pair.kernel.w(0.0) * volume(i);
            a(0, 0) += self;
            b[0] += self * (rho[i] / rho0 - 1);
            // Few neighbors, or all in a plane: no line fits them, and the density stays.
            double spread = 1;
            for (int d = 1; d <= Dim; ++d) spread *= a(d, d);
            if (a(0, 0) < 0.3 ||
                a.template bottomRightCorner<Dim, Dim>().determinant() < 0.05 * spread)
              return;
            rho[i] = rho0 * (1 + a.inverse().row(0).dot(b));
          });
    });
  }

 private:
  Needs volume_;  // what the volume needs beside mass and density
  ParticleSet<Dim>* water_ = nullptr;
};

const RegisterEffect<DensityFilter> registered_density_filter;

}  // namespace
}  // namespace sphgeo
