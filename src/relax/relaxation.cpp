#include "relax/relaxation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "geometry/normal.h"
#include "relax/missing_support.h"
#include "relax/smooth_fraction.h"
#include "sph/cell_grid.h"

namespace sphgeo {
namespace {

// Displacement of a step over h^2 times the sum of gradients, and its limit over the spacing.
constexpr double gain = 0.3;
constexpr double longest = 0.1;

template <int Dim>
class Relaxer {
 public:
  Relaxer(const Shape& water, const WaterTarget& target, Seeds seeds, double dp,
          const RelaxationOptions& options)
      : water_(water),
        target_(target),
        dp_(dp),
        options_(options),
        r_(std::move(seeds.at)),
        free_(std::move(seeds.free)) {
    const auto n = static_cast<std::size_t>(count());
    volume_.assign(n, 0);
    fraction_.assign(n, 1);
    h_.assign(n, 0);
    density_.assign(n, 1);
    depth_.assign(n, 0);
    move_.assign(n, Vec3::Zero());
    way_.assign(n, 0);
    for (std::size_t k = 0; k < n; ++k)
      if (free_[k]) moving_.push_back(static_cast<Index>(k));
  }

  RelaxedPositions run() {
    RelaxedPositions out;
    for_moving([&](Index i) {
      at(depth_, i) = 0;
      bound(i);
    });
    Aabb box;
    for (const Index i : moving_) box.extend(at(r_, i));
    if (!moving_.empty())
      smooth_.emplace(water_, target_, box.grown(2 * dp_), dp_, options_.water_h, Dim);
    parallel_for(count(), [&](Index i) { set_target(i); });
    out.start_density = density_;
    if (!moving_.empty()) {
      prepare();
      sum_forces();
      find_interior();
      out.start_density = density_;
      out.history.push_back(state());
      for (int step = 1; step <= options_.steps; ++step) {
        take_step();
        sum_forces();
        const bool last = step == options_.steps || mean_way() < options_.tolerance;
        if (last || step % 10 == 0) find_interior();
        out.history.push_back(state());
        if (last) break;
      }
      out.interior = static_cast<Index>(inner_.size());
      out.water_density_spread = water_spread();
    }
    out.at = std::move(r_);
    out.water_fraction = std::move(fraction_);
    out.number_density = std::move(density_);
    return out;
  }

 private:
  template <class T>
  static T& at(std::vector<T>& v, Index i) {
    return v[static_cast<std::size_t>(i)];
  }
  template <class T>
  static const T& at(const std::vector<T>& v, Index i) {
    return v[static_cast<std::size_t>(i)];
  }
  Index count() const { return static_cast<Index>(r_.size()); }
  template <class F>
  void for_moving(F&& f) const {
    parallel_for(static_cast<Index>(moving_.size()), [&](Index k) { f(at(moving_, k)); });
  }
  double spacing(Index i) const { return h_[static_cast<std::size_t>(i)] / options_.h_factor; }

  /// The background meshes, around all that moves.
  void prepare() {
    Aabb box;
    double low = 1;
    for (const Index i : moving_) {
      box.extend(at(r_, i));
      low = std::min(low, at(fraction_, i));
    }
    // Particles wander: a reserve for what they find.
    low = std::max(WaterTarget::smallest, 0.8 * low);
    largest_h_ = smoothing_length(WaterTarget::smallest);
    missing_.emplace(water_, box.grown(2 * dp_), smoothing_length(1), smoothing_length(low), Dim);
    Aabb all = box;
    for (const Vec3& p : r_) all.extend(p);
    frame_ = FixedPoint<Dim>::fit(to_scene<Dim>(all.lo - Vec3::Constant(dp_)),
                                  to_scene<Dim>(all.hi + Vec3::Constant(dp_)), 2 * largest_h_);
  }

  double smoothing_length(double fraction) const {
    return options_.h_factor * dp_ * std::pow(fraction, -1.0 / Dim);
  }

  /// Target volume and spacing, Eqs. 81 and 82. What is not free lies far from all soil.
  void set_target(Index i) {
    const double fraction = free_[static_cast<std::size_t>(i)] ? (*smooth_)(at(r_, i)) : 1;
    at(fraction_, i) = fraction;
    at(volume_, i) = std::pow(dp_, Dim) / fraction;
    at(h_, i) = smoothing_length(fraction);
  }

  void sort() {
    places_.resize(r_.size());
    parallel_for(count(), [&](Index i) { at(places_, i) = to_scene<Dim>(at(r_, i)); });
    double h = 0;
    for (const Index i : moving_) h = std::max(h, at(h_, i));
    grid_.build({places_.data(), places_.size()}, frame_, h);
  }

  /// Number density, and the displacement of Eqs. 84 and 85: with p0 = 1 and the time step of the
  /// acceleration criterion the factors before the sums make gain h^2, and no way is longer than a
  /// tenth of the spacing.
  void sum_forces() {
    sort();
    for_moving([&](Index i) {
      const double h = at(h_, i);
      const RelaxKernel kernel(h, Dim);
      const LevelSetMesh::Missing beyond = (*missing_)(at(r_, i), h);
      Vec<Dim> gradient = to_scene<Dim>(beyond.gradient);
      double sum = beyond.sum;
      const Vec<Dim> p = at(places_, i);
      // The kernel and its slope as RelaxKernel has them, with what they share computed once.
      const double top = kernel.value(0), steepest = kernel.slope(0), per_h = 1 / h;
      grid_.for_each_in_reach(p, kernel.support(), [&](Index j, double r2) {
        const double q = std::sqrt(r2) * per_h, a = std::max(0.0, 1 - 0.5 * q), v = at(volume_, j);
        const double a3v = a * a * a * v;
        sum += top * a3v * a * (2 * q + 1);
        gradient += steepest * a3v * (p - at(places_, j));
      });
      Vec3 move = -gain * h * h * to_space<Dim>(gradient);
      const double length = move.norm(), most = longest * spacing(i);
      if (length > most) move *= most / length;
      at(move_, i) = move;
      at(density_, i) = sum;
    });
  }

  void take_step() {
    for_moving([&](Index i) {
      const Vec3 before = at(r_, i);
      at(r_, i) += at(move_, i);
      at(depth_, i) += at(move_, i).norm();
      bound(i);
      const double way = (at(r_, i) - before).norm();
      at(way_, i) = way / spacing(i);
      set_target(i);
    });
  }

  /// Surface bounding, Eq. 86. depth_ is an upper limit of the signed distance: it grows with the
  /// way travelled, and only particles that may have come near the surface ask the shape again.
  void bound(Index i) {
    if (at(depth_, i) < -0.5 * dp_) return;
    Vec3& p = at(r_, i);
    double d = water_.signed_distance(p);
    // Again where the first projection, along a straight normal, missed by a thousandth.
    for (int k = 0; k < 3 && d > (k == 0 ? -0.5 : -0.499) * dp_; ++k) {
      const Vec3 way = (d + 0.5 * dp_) * outward_normal(water_, p, 0.05 * dp_, Dim);
      p -= way;
      d = water_.signed_distance(p);
    }
    at(depth_, i) = d;
  }

  /// Free particles whose kernel does not reach the surface; all free ones when there are none. A
  /// distance may be dear, so that this is not asked at each step.
  void find_interior() {
    for_moving([&](Index i) {
      if (at(depth_, i) >= -2 * at(h_, i)) at(depth_, i) = water_.signed_distance(at(r_, i));
    });
    inner_.clear();
    for (const Index i : moving_)
      if (at(depth_, i) < -2 * at(h_, i)) inner_.push_back(i);
    if (inner_.empty()) inner_ = moving_;
  }

  double mean_way() const {
    const auto n = static_cast<Index>(moving_.size());
    return ordered_sum(n, [&](Index k) { return at(way_, at(moving_, k)); }) /
           static_cast<double>(n);
  }

  struct Moments {
    double n = 0, sum = 0, square = 0;
    Moments& operator+=(const Moments& b) {
      n += b.n;
      sum += b.sum;
      square += b.square;
      return *this;
    }
    double mean() const { return sum / n; }
    double spread() const {
      return std::sqrt(std::max(0.0, square / n - mean() * mean())) / mean();
    }
  };

  RelaxationStep state() const {
    const auto n = static_cast<Index>(inner_.size());
    const Moments m = ordered_sum(n, [&](Index k) {
      const double s = at(density_, at(inner_, k));
      return Moments{1, s, s * s};
    });
    RelaxationStep out;
    out.density_mean = m.mean();
    out.density_spread = m.spread();
    out.density_low = block_min(n, [&](Index k) { return at(density_, at(inner_, k)); });
    out.density_high = block_max(n, [&](Index k) { return at(density_, at(inner_, k)); });
    out.mean_move = mean_way();
    out.largest_move = block_max(static_cast<Index>(moving_.size()),
                                 [&](Index k) { return at(way_, at(moving_, k)); });
    return out;
  }

  /// The spread of the density that the kernel of the run sees.
  double water_spread() const {
    const RelaxKernel kernel(options_.water_h, Dim);
    return ordered_sum(static_cast<Index>(inner_.size()),
                       [&](Index k) {
                         double sum = 0;
                         const Index i = at(inner_, k);
                         grid_.for_each_in_reach(
                             at(places_, i), kernel.support(), [&](Index j, double r2) {
                               sum += kernel.value(std::sqrt(r2)) * at(volume_, j);
                             });
                         return Moments{1, sum, sum * sum};
                       })
        .spread();
  }

  const Shape& water_;
  const WaterTarget& target_;
  double dp_;
  RelaxationOptions options_;
  std::vector<Vec3> r_;
  std::vector<char> free_;
  std::vector<Index> moving_, inner_;
  std::vector<double> volume_, fraction_, h_, density_;
  std::vector<double> depth_;  // upper limit of the signed distance
  std::vector<double> way_;    // of the last step, over the spacing
  std::optional<SmoothFraction> smooth_;
  std::vector<Vec3> move_;
  std::vector<Vec<Dim>> places_;
  double largest_h_ = 0;
  std::optional<MissingSupport> missing_;
  FixedPoint<Dim> frame_;
  CellGrid<Dim> grid_;
};

}  // namespace

RelaxedPositions relax(const Shape& water, const WaterTarget& target, Seeds seeds, double dp,
                       int dim, const RelaxationOptions& options) {
  if (dim == 2) return Relaxer<2>(water, target, std::move(seeds), dp, options).run();
  return Relaxer<3>(water, target, std::move(seeds), dp, options).run();
}

}  // namespace sphgeo
