#include "geometry/relax_fill.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "geometry/fill.h"
#include "geometry/level_set_mesh.h"
#include "geometry/normal.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {

/// Particles sorted by cells as wide as the kernel support; order within a cell is by index.
class CellGrid {
 public:
  CellGrid(const Aabb& around, double width, int dim) : lo_(around.lo), width_(width), dim_(dim) {
    for (int k = 0; k < 3; ++k)
      n_[k] =
          dim == 2 && k == 1
              ? 1
              : std::max<Index>(1, static_cast<Index>(std::ceil((around.hi[k] - lo_[k]) / width)));
  }

  void sort(const std::vector<Vec3>& r) {
    start_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2] + 1), 0);
    cell_.resize(r.size());
    parallel_for(static_cast<Index>(r.size()), [&](Index i) {
      const auto k = static_cast<std::size_t>(i);
      cell_[k] = index(coordinate(r[k], 0), coordinate(r[k], 1), coordinate(r[k], 2));
    });
    for (const Index c : cell_) ++start_[static_cast<std::size_t>(c + 1)];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    sorted_.resize(r.size());
    for (std::size_t i = 0; i < r.size(); ++i)
      sorted_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell_[i])]++)] = r[i];
  }

  /// Calls f(apart, distance) for all others than p itself within `support` of p.
  template <class F>
  void around(const Vec3& p, double support, F&& f) const {
    const Index cx = coordinate(p, 0), cy = coordinate(p, 1), cz = coordinate(p, 2);
    for (Index z = std::max<Index>(cz - 1, 0); z <= std::min(cz + 1, n_[2] - 1); ++z)
      for (Index y = std::max<Index>(cy - 1, 0); y <= std::min(cy + 1, n_[1] - 1); ++y) {
        const auto first = static_cast<std::size_t>(index(std::max<Index>(cx - 1, 0), y, z));
        const auto last = static_cast<std::size_t>(index(std::min(cx + 1, n_[0] - 1), y, z));
        for (Index k = start_[first]; k < start_[last + 1]; ++k) {
          const Vec3 apart = p - sorted_[static_cast<std::size_t>(k)];
          const double r2 = apart.squaredNorm();
          if (r2 < support * support && r2 > 0.0) f(apart, std::sqrt(r2));
        }
      }
  }

 private:
  Index coordinate(const Vec3& p, int k) const {
    if (dim_ == 2 && k == 1) return 0;
    return std::clamp<Index>(static_cast<Index>((p[k] - lo_[k]) / width_), 0, n_[k] - 1);
  }
  Index index(Index x, Index y, Index z) const { return (z * n_[1] + y) * n_[0] + x; }

  Vec3 lo_;
  double width_;
  int dim_;
  Index n_[3];
  std::vector<Index> start_, cell_;
  std::vector<Vec3> sorted_;
};

/// Number density and displacement of one step.
struct Moves {
  std::vector<Vec3> move;
  std::vector<double> density;
};

class Relaxation {
 public:
  Relaxation(const Shape& shape, std::vector<Vec3> start, double dp, int dim,
             const RelaxFillOptions& options)
      : shape_(shape),
        dp_(dp),
        dim_(dim),
        options_(options),
        kernel_(options.h_factor * dp, dim),
        r_(std::move(start)),
        box_(around(r_, dp)),
        mesh_(shape, box_, 0.5 * dp, kernel_, dim),
        grid_(box_, kernel_.support(), dim),
        depth_(r_.size(), 0.0),
        moved_(r_.size(), 0.0) {
    volume_ = mesh_.volume() / static_cast<double>(r_.size());
    moves_.move.resize(r_.size());
    moves_.density.resize(r_.size());
  }

  RelaxFillResult run() {
    RelaxFillResult result;
    parallel_for(static_cast<Index>(r_.size()), [&](Index i) { bound(i); });
    for (int step = 0; step < options_.steps && !result.converged; ++step) {
      sum_forces();
      move();
      double sum = 0.0, most = 0.0;
      for (const double m : moved_) {
        sum += m;
        most = std::max(most, m);
      }
      const double mean = sum / static_cast<double>(r_.size());
      result.history.push_back({mean, most, spread()});
      result.converged = mean < options_.tolerance;
    }
    sum_forces();
    result.density_spread = spread();
    const auto [low, high] = std::minmax_element(moves_.density.begin(), moves_.density.end());
    result.density_low = *low;
    result.density_high = *high;
    result.surface_offset = surface_offset();
    result.particle_volume = volume_;
    result.positions = std::move(r_);
    return result;
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

  static Aabb around(const std::vector<Vec3>& r, double margin) {
    Aabb b;
    for (const Vec3& p : r) b.extend(p);
    return b.grown(2.0 * margin);
  }

  /// Eq. (84) with p0 = 1, one density and one volume, and the displacement of Eq. (85). The pseudo
  /// time step is the smaller of two: that which keeps close pairs from swinging (it makes the
  /// movement 0.3 h^2 times the sum of gradients) and that which limits the movement to 0.1 dp.
  void sum_forces() {
    grid_.sort(r_);
    const double gain = 0.3 * kernel_.h() * kernel_.h();
    parallel_for(static_cast<Index>(r_.size()), [&](Index i) {
      const Vec3& p = at(r_, i);
      const LevelSetMesh::Missing beyond = mesh_.missing(p);
      Vec3 gradient = beyond.gradient;
      double sum = beyond.sum + kernel_.value(0.0) * volume_;
      grid_.around(p, kernel_.support(), [&](const Vec3& apart, double r) {
        gradient += kernel_.slope(r) * volume_ * apart;
        sum += kernel_.value(r) * volume_;
      });
      Vec3 move = -gain * gradient;
      const double length = move.norm();
      if (length > 0.1 * dp_) move *= 0.1 * dp_ / length;
      at(moves_.move, i) = move;
      at(moves_.density, i) = sum;
    });
  }

  /// One step of Eqs. (85) and (86), and the way of each particle as a share of dp.
  void move() {
    parallel_for(static_cast<Index>(r_.size()), [&](Index i) {
      const Vec3 before = at(r_, i);
      at(r_, i) += at(moves_.move, i);
      at(depth_, i) += at(moves_.move, i).norm();
      bound(i);
      at(moved_, i) = (at(r_, i) - before).norm() / dp_;
    });
  }

  /// Surface bounding, Eq. (86). depth_ is an upper limit of the signed distance: it grows with the
  /// way travelled, and only particles that may have come near the surface ask the shape again.
  void bound(Index i) {
    if (at(depth_, i) < -0.5 * dp_) return;
    Vec3& p = at(r_, i);
    double d = shape_.signed_distance(p);
    // A second projection only where the first, along a straight normal, missed by a thousandth.
    for (int k = 0; k < 3 && d > (k == 0 ? -0.5 : -0.499) * dp_; ++k) {
      p -= (d + 0.5 * dp_) * outward_normal(shape_, p, 0.05 * dp_, dim_);
      d = shape_.signed_distance(p);
    }
    at(depth_, i) = d;
  }

  double spread() const {
    double sum = 0.0, square = 0.0;
    for (const double d : moves_.density) sum += d;
    const double n = static_cast<double>(r_.size()), mean = sum / n;
    for (const double d : moves_.density) square += (d - mean) * (d - mean);
    return std::sqrt(square / n) / mean;
  }

  /// The outermost particles are those nearer to the surface than the gap between the first two
  /// layers.
  double surface_offset() const {
    double square = 0.0, count = 0.0;
    for (const Vec3& p : r_) {
      const double d = shape_.signed_distance(p);
      if (d < -0.9 * dp_) continue;
      square += (d / dp_ + 0.5) * (d / dp_ + 0.5);
      count += 1.0;
    }
    return count > 0.0 ? std::sqrt(square / count) : 0.0;
  }

  const Shape& shape_;
  double dp_;
  int dim_;
  RelaxFillOptions options_;
  RelaxKernel kernel_;
  std::vector<Vec3> r_;
  Aabb box_;
  LevelSetMesh mesh_;
  CellGrid grid_;
  std::vector<double> depth_;  // upper limit of the signed distance
  std::vector<double> moved_;
  double volume_ = 0.0;
  Moves moves_;
};

}  // namespace

RelaxFillResult relax_positions(const Shape& shape, std::vector<Vec3> start, double dp, int dim,
                                const RelaxFillOptions& options) {
  if (start.empty()) return {};
  return Relaxation(shape, std::move(start), dp, dim, options).run();
}

RelaxFillResult relax_fill(const Shape& shape, double dp, int dim,
                           const RelaxFillOptions& options) {
  return relax_positions(shape, fill_lattice(shape, dp, dim, options.clip), dp, dim, options);
}

}  // namespace sphgeo
