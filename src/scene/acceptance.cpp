#include "scene/acceptance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "geometry/fill.h"
#include "geometry/shapes.h"

namespace sphgeo {
namespace {

// Water of a cell within this of 1 is a whole particle.
constexpr double whole = 1 - 1e-9;
// Finer cells along the edge of one that a surface cuts.
int parts(int dim) { return dim == 3 ? 4 : 12; }
// Width of the draws about the middle of their stretch. 0 would leave no choice to the seed; after
// 100 steps 1 gives no other spread than 0.5 (0.2 to 0.7 %), but clumps more at the start where
// porosity varies (7 against 5.5 %).
constexpr double draw_width = 0.5;

/// The lattice of fill_lattice, with the cells whose centres lie outside.
struct Lattice {
  Vec3 origin;
  std::array<Index, 3> count;
  double dp;
  int dim;

  Lattice(const Shape& body, double spacing, int dimension) : dp(spacing), dim(dimension) {
    const Aabb box = body.box();
    origin = box.lo;
    for (int k = 0; k < 3; ++k)
      count[static_cast<std::size_t>(k)] =
          dim == 2 && k == 1
              ? 1
              : std::max<Index>(1,
                                static_cast<Index>(std::ceil((box.hi[k] - box.lo[k]) / dp - 1e-6)));
    if (dim == 2) origin.y() = -0.5 * dp;
  }
  Index rows() const { return count[1] * count[2]; }
  Vec3 centre(Index i, Index row) const {
    return origin + dp * Vec3(static_cast<double>(i) + 0.5,
                              static_cast<double>(row % count[1]) + 0.5,
                              static_cast<double>(row / count[1]) + 0.5);
  }
};

/// Calls f(point) at the centres of n^dim equal parts of a cell.
template <class F>
void for_each_part(const Vec3& at, double edge, int n, int dim, F&& f) {
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < (dim == 3 ? n : 1); ++j)
      for (int i = 0; i < n; ++i) {
        const auto offset = [&](int a) { return ((a + 0.5) / n - 0.5) * edge; };
        f(Vec3(at + Vec3(offset(i), dim == 3 ? offset(j) : 0, offset(k))));
      }
}

class CellWater {
 public:
  CellWater(const Shape& body, const WaterTarget& target, double dp, int dim)
      : body_(body),
        target_(target),
        dp_(dp),
        dim_(dim),
        half_diagonal_(0.5 * std::sqrt(dim) * dp * (1 + 1e-9)) {}

  double operator()(const Vec3& at) const {
    const double bound = body_.bound(at);
    if (bound >= half_diagonal_) return 0;
    const bool within = bound <= -half_diagonal_ || covers(at);
    const WaterTarget::Where soil = target_.locate(at);
    if (!within || soil.holds < half_diagonal_) return cut(at, within);
    if (soil.soil < 0) return 1;
    return uncut(soil.soil, at);
  }

 private:
  /// Whether the body fills a cell, as far as the corners of its parts tell: cheaper than the
  /// distance within a body whose parts touch.
  bool covers(const Vec3& at) const {
    const int n = parts(dim_) + 1;
    bool all = true;
    for_each_part(at, dp_ * n / (n - 1), n, dim_,
                  [&](const Vec3& p) { all = all && body_.bound(p) <= 0; });
    return all;
  }
  double cut(const Vec3& at, bool within) const {
    const int n = parts(dim_);
    const double edge = dp_ / n;
    double sum = 0;
    for_each_part(at, dp_, n, dim_, [&](const Vec3& p) {
      const double inside =
          within ? 1.0 : std::clamp(0.5 - distance_near(body_, p, edge) / edge, 0.0, 1.0);
      if (inside > 0) sum += inside * checked(target_.mean_fraction(p, edge), p);
    });
    return sum / std::pow(n, dim_);
  }
  double uncut(int soil, const Vec3& at) const {
    if (target_.soils()[static_cast<std::size_t>(soil)].amount.is_constant())
      return checked(target_.fraction_in(soil, at), at);
    // Gauss points lie 1/sqrt(12) of the edge beside the middle: where the halves of a larger cell
    // have theirs.
    double sum = 0, low = 2, high = -1;
    for_each_part(at, dp_ * 2 / std::sqrt(3.0), 2, dim_, [&](const Vec3& p) {
      const double f = checked(target_.fraction_in(soil, p), p);
      sum += f;
      low = std::min(low, f);
      high = std::max(high, f);
    });
    if (high - low <= 0.05) return sum / std::pow(2, dim_);
    // A formula with a jump.
    sum = 0;
    const int n = parts(dim_);
    for_each_part(at, dp_, n, dim_,
                  [&](const Vec3& p) { sum += checked(target_.fraction_in(soil, p), p); });
    return sum / std::pow(n, dim_);
  }
  static double checked(double fraction, const Vec3& at) {
    if (fraction >= WaterTarget::smallest && fraction <= 1 + 1e-12) return std::min(fraction, 1.0);
    const std::string place = fmt::format("({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
    if (fraction < WaterTarget::smallest && fraction >= 0)
      throw Error(ExitCode::usage,
                  fmt::format("the pores of the soil at {} hold {:.3g} of its volume of water, "
                              "less than {}: too little to be filled with particles",
                              place, fraction, WaterTarget::smallest));
    throw Error(
        ExitCode::usage,
        fmt::format(
            "the volume fraction of the soil in the water at {} is {}, and not between 0 and 1",
            place, 1 - fraction));
  }

  const Shape& body_;
  const WaterTarget& target_;
  double dp_;
  int dim_;
  double half_diagonal_;
};

/// Marks what lies within `reach` cells of a marked one, axis by axis: a cube around each.
void spread_marks(std::vector<char>& marks, const std::array<Index, 3>& count, Index reach) {
  const Index strides[3] = {1, count[0], count[0] * count[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Index n = count[axis], stride = strides[axis];
    if (n == 1) continue;
    parallel_blocks(static_cast<Index>(marks.size()) / n, 64, [&](Index begin, Index end, Index) {
      std::vector<char> line(static_cast<std::size_t>(n));
      for (Index l = begin; l < end; ++l) {
        const Index start = l / stride * stride * n + l % stride;
        const auto at = [&](Index k) -> char& {
          return marks[static_cast<std::size_t>(start + k * stride)];
        };
        Index last = -reach - 1;  // the marked cell before
        for (Index k = 0; k < n; ++k) {
          if (at(k)) last = k;
          line[static_cast<std::size_t>(k)] = k - last <= reach;
        }
        last = n + reach;
        for (Index k = n - 1; k >= 0; --k) {
          if (at(k)) last = k;
          if (last - k <= reach) line[static_cast<std::size_t>(k)] = 1;
        }
        for (Index k = 0; k < n; ++k) at(k) = line[static_cast<std::size_t>(k)];
      }
    });
  }
}

}  // namespace

std::vector<Candidate> candidates(const Shape& body, const WaterTarget& target, double dp, int dim,
                                  double reach) {
  const Aabb box = body.box();
  const Vec3 cells = ((box.hi - box.lo) / dp).cwiseMax(1.0);
  if (!(cells.allFinite() && (dim == 3 ? cells.prod() : cells.x() * cells.z()) <= largest_fill))
    return fill_lattice(body, dp, dim), std::vector<Candidate>{};
  if (box.empty()) return {};
  const Lattice lattice(body, dp, dim);
  const CellWater water(body, target, dp, dim);
  const Index nx = lattice.count[0];
  std::vector<double> filled(static_cast<std::size_t>(nx * lattice.rows()));
  parallel_blocks(lattice.rows(), 8, [&](Index begin, Index end, Index) {
    for (Index row = begin; row < end; ++row)
      for (Index i = 0; i < nx; ++i) {
        const double w = water(lattice.centre(i, row));
        filled[static_cast<std::size_t>(row * nx + i)] = w >= whole ? 1 : w;
      }
  });
  std::vector<char> marks(filled.size());
  for (std::size_t k = 0; k < filled.size(); ++k) marks[k] = filled[k] > 1e-9 && filled[k] < 1;
  spread_marks(marks, lattice.count, static_cast<Index>(std::ceil(reach / dp)));
  std::vector<Candidate> out;
  for (std::size_t k = 0; k < filled.size(); ++k)
    if (filled[k] > 1e-9)
      out.push_back({lattice.centre(static_cast<Index>(k) % nx, static_cast<Index>(k) / nx),
                     filled[k], marks[k] != 0});
  if (dim == 2)
    for (Candidate& c : out) c.at.y() = 0;
  return out;
}

double water_volume(const std::vector<Candidate>& all) {
  return ordered_sum(static_cast<Index>(all.size()),
                     [&](Index k) { return all[static_cast<std::size_t>(k)].water; });
}

std::uint64_t hilbert_index(const std::uint32_t* cell, int dim, int bits) {
  // Skilling's transform (AIP Conf. Proc. 707, 381): undo the turns of all finer levels, then
  // Gray-code.
  std::uint32_t x[3] = {cell[0], cell[1], dim == 3 ? cell[2] : 0};
  for (std::uint32_t level = 1u << (bits - 1); level > 1; level >>= 1) {
    const std::uint32_t below = level - 1;
    for (int k = 0; k < dim; ++k) {
      if (x[k] & level) {
        x[0] ^= below;
      } else {
        const std::uint32_t swap = (x[0] ^ x[k]) & below;
        x[0] ^= swap;
        x[k] ^= swap;
      }
    }
  }
  for (int k = 1; k < dim; ++k) x[k] ^= x[k - 1];
  std::uint32_t turn = 0;
  for (std::uint32_t level = 1u << (bits - 1); level > 1; level >>= 1)
    if (x[dim - 1] & level) turn ^= level - 1;
  for (int k = 0; k < dim; ++k) x[k] ^= turn;
  std::uint64_t out = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (int k = 0; k < dim; ++k) out = out << 1 | (x[k] >> b & 1);
  return out;
}

namespace {

/// The candidates that are not whole, along the curve.
std::vector<std::size_t> along_curve(const std::vector<Candidate>& all, double dp, int dim) {
  Aabb box;
  for (const Candidate& c : all) box.extend(c.at);
  const double widest = all.empty() ? 0 : (box.hi - box.lo).maxCoeff() / dp;
  int bits = 1;
  while (std::exp2(bits) < widest + 1 && bits < 20) ++bits;
  std::vector<std::pair<std::uint64_t, std::size_t>> keys;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].water == 1) continue;
    const auto cell = [&](int axis) {
      return static_cast<std::uint32_t>(std::llround((all[k].at[axis] - box.lo[axis]) / dp));
    };
    const std::uint32_t flat[2] = {cell(0), cell(2)}, full[3] = {cell(0), cell(1), cell(2)};
    keys.emplace_back(hilbert_index(dim == 2 ? flat : full, dim, bits), k);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> out;
  for (const auto& [key, k] : keys) out.push_back(k);
  return out;
}

}  // namespace

std::vector<std::size_t> accept(const std::vector<Candidate>& all, Acceptance kind,
                                std::uint64_t seed, double dp, int dim) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].water == 1) out.push_back(k);
  const std::vector<std::size_t> cut = along_curve(all, dp, dim);
  double volume = 0;
  for (const std::size_t k : cut) volume += all[k].water;
  const auto wanted =
      std::min<std::size_t>(static_cast<std::size_t>(std::llround(volume)), cut.size());
  if (kind == Acceptance::independent) {
    // The first arrivals of clocks that run as fast as there is water: each accepted by its own
    // draw, but for the total, which is that of the water.
    std::vector<std::pair<double, std::size_t>> arrival;
    for (const std::size_t k : cut)
      arrival.emplace_back(
          -std::log1p(-random_uniform(seed, k)) / -std::log1p(-std::min(all[k].water, whole)), k);
    std::sort(arrival.begin(), arrival.end());
    for (std::size_t k = 0; k < wanted; ++k) out.push_back(arrival[k].second);
  } else {
    const double scale = volume > 0 ? static_cast<double>(wanted) / volume : 1;
    const auto threshold = [&](std::size_t n) {
      return static_cast<double>(n) + 0.5 + draw_width * (random_uniform(seed, n) - 0.5);
    };
    std::size_t due = 0, taken = 0;  // thresholds passed, particles placed
    double sum = 0;
    for (std::size_t m = 0; m < cut.size() && taken < wanted; ++m) {
      sum += scale * all[cut[m]].water;
      while (due < wanted && threshold(due) <= sum) ++due;
      // The last cells take what round-off has left over.
      if (due > taken || wanted - taken == cut.size() - m) {
        out.push_back(cut[m]);
        ++taken;
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace sphgeo
