#include "geometry/relaxation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "geometry/fill.h"
#include "geometry/level_set_mesh.h"
#include "geometry/normal.h"
#include "sph/variable_sums.h"

namespace sphgeo {
namespace {

// Displacement of a step over h^2 times the sum of gradients, and its limit over the spacing.
constexpr double relaxation_gain = 0.3;
constexpr double longest_move = 0.1;
// An interpolated distance is taken for that to a plane when the length of its gradient is 1 to
// within this.
constexpr double plane_enough = 0.01;
// Shares of dp: what any other may be too small by, and how far particles may come too near to the
// surface there, on the way, before the distance itself is asked.
constexpr double interpolation_error = 0.2;
constexpr double bounding_slack = 0.02;
// A kernel that misses less than this does not reach the surface: it ends 1.8 h away from a plane.
constexpr double nothing_missed = 1e-6;

template <int Dim>
class Relaxer {
 public:
  Relaxer(const Shape& shape, const RelaxationTarget& target, Seeds seeds, double dp,
          const RelaxationOptions& options)
      : shape_(shape),
        target_(target),
        dp_(dp),
        options_(options),
        r_(seeds.at.size()),
        free_(std::move(seeds.free)),
        volume_of_one_(target.volume),
        fraction_(r_.size(), 1.0),
        density_(r_.size(), 1.0),
        gradient_(r_.size()) {
    for (auto* each : {&volume_, &h_, &depth_, &missed_, &way_}) each->resize(r_.size());
    if (free_.empty()) free_.assign(r_.size(), 1);
    for (std::size_t k = 0; k < r_.size(); ++k) {
      r_[k] = to_scene<Dim>(seeds.at[k]);
      if (free_[k]) moving_.push_back(static_cast<Index>(k));
    }
  }

  RelaxedPositions run() {
    RelaxedPositions out;
    set_targets();
    if (!moving_.empty()) {
      prepare();
      set_targets();
      sum();
      find_interior();
      out.history.push_back(state());
    }
    out.start_density = density_;
    bool last = moving_.empty() || options_.steps == 0;
    for (int step = 1; !last; ++step) {
      take_step();
      last = step == options_.steps || mean_way() < options_.tolerance;
      if (last)
        for_moving([&](Index i) {
          bound(i, true);
          set_target(i);
        });
      sum();
      if (last || step % 10 == 0) find_interior();
      out.history.push_back(state());
    }
    out.interior = static_cast<Index>(inner_.size());
    if (options_.run_h > 0 && !inner_.empty()) out.run_density_spread = run_spread();
    for (const Vec<Dim>& p : r_) out.at.push_back(to_space<Dim>(p));
    out.fraction = std::move(fraction_);
    out.number_density = std::move(density_);
    out.volume = volume_of_one_;
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
  template <class F>
  void for_moving(F&& f) const {
    parallel_for(static_cast<Index>(moving_.size()), [&](Index k) { f(at(moving_, k)); });
  }
  double spacing(Index i) const { return at(h_, i) / options_.h_factor; }

  double smoothing_length(double fraction) const {
    const double volume = 1 / fraction;
    return options_.h_factor * dp_ * (Dim == 2 ? std::sqrt(volume) : std::cbrt(volume));
  }

  /// Target volume and smoothing length, Eqs. 81 and 82.
  void set_target(Index i) {
    if (target_.fraction && free_[static_cast<std::size_t>(i)])
      at(fraction_, i) = target_.fraction(to_space<Dim>(at(r_, i)));
    at(volume_, i) = volume_of_one_ / at(fraction_, i);
    at(h_, i) = smoothing_length(at(fraction_, i));
  }

  void set_targets() {
    parallel_for(static_cast<Index>(r_.size()), [&](Index i) { set_target(i); });
  }

  /// The background meshes around all that moves, and the first bounding.
  void prepare() {
    Aabb box, all;
    double low = 1, high = 0;
    for (const Index i : moving_) {
      box.extend(to_space<Dim>(at(r_, i)));
      low = std::min(low, at(fraction_, i));
      high = std::max(high, at(fraction_, i));
    }
    for (const Vec<Dim>& p : r_) all.extend(to_space<Dim>(p));
    // Particles wander: a reserve for what they find.
    low = std::max(target_.smallest_fraction, 0.8 * low);
    high = std::min(1.0, 1.25 * high);
    missing_.emplace(shape_, box.grown(2 * dp_), smoothing_length(high), smoothing_length(low));
    if (volume_of_one_ == 0)
      volume_of_one_ = missing_->surface().volume() / static_cast<double>(r_.size());
    const Vec3 margin = Vec3::Constant(dp_);
    frame_ = FixedPoint<Dim>::fit(to_scene<Dim>(all.lo - margin), to_scene<Dim>(all.hi + margin),
                                  2 * smoothing_length(target_.smallest_fraction));
    sums_.emplace(frame_, static_cast<Index>(r_.size()), moving_);
    for_moving([&](Index i) { bound(i, options_.steps == 0); });
  }

  /// Number density, and the bracket of Eq. 84.
  void sum() {
    sums_->compute(r_, volume_, h_, density_, gradient_);
    for_moving([&](Index i) {
      at(missed_, i) = 0;
      if (at(depth_, i) < -2 * at(h_, i)) return;
      const auto beyond = (*missing_)(at(r_, i), at(h_, i));
      at(missed_, i) = beyond.sum;
      at(density_, i) += beyond.sum;
      at(gradient_, i) += beyond.gradient;
    });
  }

  /// Eqs. 84 and 85: with p0 = 1 and the time step of the acceleration criterion the factors before
  /// the sums make relaxation_gain h^2, and no way is longer than a tenth of the spacing.
  void take_step() {
    for_moving([&](Index i) {
      const Vec<Dim> before = at(r_, i);
      Vec<Dim> move = -relaxation_gain * at(h_, i) * at(h_, i) * at(gradient_, i);
      const double most = longest_move * spacing(i), length = move.norm();
      if (length > most) move *= most / length;
      at(r_, i) += move;
      at(depth_, i) += std::min(length, most);
      bound(i, false);
      at(way_, i) = (at(r_, i) - before).norm() / spacing(i);
      set_target(i);
    });
  }

  /// Surface bounding, Eq. 86. depth_ is about the signed distance, or more: it grows with the way
  /// travelled, and only particles that may have come near the surface look again. On the way the
  /// mesh tells where the surface is plane for it; the distance itself may be expensive.
  void bound(Index i, bool exactly) {
    double& depth = at(depth_, i);
    const double level = -0.5 * dp_, error = interpolation_error * dp_;
    if (depth < (exactly ? level - error : level)) return;
    Vec<Dim>& p = at(r_, i);
    const auto known = missing_->surface().distance(p);
    if (!exactly && std::abs(known.gradient.norm() - 1) < plane_enough) {
      const Vec<Dim> moved = p - std::max(known.value - level, 0.0) * known.gradient.normalized();
      // In a part thinner than a spacing the surface on the other side may be nearer then.
      if (known.value <= level ||
          missing_->surface().distance(moved).value < level + bounding_slack * dp_) {
        p = moved;
        depth = std::min(known.value, level);
        return;
      }
    }
    depth = std::min(depth, known.value + error);
    if (depth < (exactly ? level : level + bounding_slack * dp_)) return;
    depth = shape_.signed_distance(to_space<Dim>(p));
    // Again where the first projection, along a straight normal, missed by a thousandth. On the
    // ridge in the middle of a thin part, and beyond the band, the mesh has no direction: the shape
    // is asked. In the middle of a part thinner than a spacing the particle stays.
    for (int k = 0; k < 3 && depth > level + 0.001 * dp_; ++k) {
      const bool ask = exactly || !(known.gradient.norm() > 0.9);
      const Vec<Dim> normal =
          ask ? to_scene<Dim>(outward_normal(shape_, to_space<Dim>(p), 0.05 * dp_, Dim))
              : Vec<Dim>(known.gradient.normalized());
      // A shorter way where the whole one leads through to the other side.
      double way = depth - level, there = depth;
      Vec<Dim> moved = p;
      for (int half = 0; half < 5 && !(there < depth); ++half, way *= 0.5) {
        moved = p - way * normal;
        there = shape_.signed_distance(to_space<Dim>(moved));
      }
      if (!(there < depth)) break;
      p = moved;
      depth = there;
    }
  }

  /// Free particles whose kernel does not reach the surface; all free ones when there are none.
  void find_interior() {
    inner_.clear();
    for (const Index i : moving_)
      if (at(missed_, i) < nothing_missed) inner_.push_back(i);
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

  /// Of the densities of the interior.
  Moments moments(const std::vector<double>& density) const {
    return ordered_sum(static_cast<Index>(inner_.size()), [&](Index k) {
      const double s = at(density, at(inner_, k));
      return Moments{1, s, s * s};
    });
  }

  RelaxationStep state() const {
    const auto n = static_cast<Index>(inner_.size());
    const Moments m = moments(density_);
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
  double run_spread() const {
    std::vector<double> density(r_.size());
    std::vector<Vec<Dim>> gradient(r_.size());
    const std::vector<double> h(r_.size(), options_.run_h);
    VariableSums<Dim>(frame_, static_cast<Index>(r_.size()), inner_)
        .compute(r_, volume_, h, density, gradient);
    return moments(density).spread();
  }

  const Shape& shape_;
  const RelaxationTarget& target_;
  double dp_;
  RelaxationOptions options_;
  std::vector<Vec<Dim>> r_;
  std::vector<char> free_;
  std::vector<Index> moving_, inner_;
  double volume_of_one_;
  std::vector<double> volume_, fraction_, h_, density_;
  std::vector<double> depth_;   // about the signed distance, or more
  std::vector<double> missed_;  // by the kernel beyond the surface
  std::vector<double> way_;     // of the last step, over the spacing
  std::vector<Vec<Dim>> gradient_;
  std::optional<MissingSupport<Dim>> missing_;
  FixedPoint<Dim> frame_;
  std::optional<VariableSums<Dim>> sums_;
};

}  // namespace

RelaxedPositions relax(const Shape& shape, const RelaxationTarget& target, Seeds seeds, double dp,
                       int dim, const RelaxationOptions& options) {
  if (dim == 2) return Relaxer<2>(shape, target, std::move(seeds), dp, options).run();
  return Relaxer<3>(shape, target, std::move(seeds), dp, options).run();
}

RelaxedPositions relax_fill(const Shape& shape, double dp, int dim) {
  RelaxationOptions options;
  options.steps = 200;
  options.tolerance = 5e-4;
  options.h_factor = 1.3;
  return relax(shape, {}, {fill_lattice(shape, dp, dim), {}}, dp, dim, options);
}

}  // namespace sphgeo
