#include "geometry/fill.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {

/// The part of `box` within `clip`; an empty clip means no clip.
Aabb clipped(Aabb box, const Aabb& clip) {
  if (clip.empty()) return box;
  box.lo = box.lo.cwiseMax(clip.lo);
  box.hi = box.hi.cwiseMin(clip.hi);
  return box;
}

/// y is left out in 2D.
Aabb in_scene(Aabb box, int dim) {
  if (dim == 2) box.lo.y() = box.hi.y() = 0.0;
  return box;
}

void refuse_unbounded(const Aabb& box) {
  if (!box.lo.allFinite() || !box.hi.allFinite())
    throw Error(ExitCode::usage,
                "the shape is unbounded and cannot be filled: intersect it with a box");
}

/// Result for a lattice point: accepted or not, and the distance (m) within which this surely
/// holds.
struct Verdict {
  bool accept;
  double holds;
};

/// Range of cells k whose centres origin + (k + 1/2) dp lie in [lo, hi]; round-off of a millionth
/// of a cell does not change the range.
struct Range {
  Index first = 0, last = -1;
  Index size() const { return std::max<Index>(last - first + 1, 0); }
};
Range cells(double lo, double hi, double origin, double dp) {
  return {static_cast<Index>(std::ceil((lo - origin) / dp - 0.5 - 1e-6)),
          static_cast<Index>(std::floor((hi - origin) / dp - 0.5 + 1e-6))};
}

std::vector<Vec3> collect(const Aabb& box, const Vec3& origin, double dp, int dim,
                          const std::function<Verdict(const Vec3&)>& judge) {
  const Range x = cells(box.lo.x(), box.hi.x(), origin.x(), dp);
  const Range y = dim == 3 ? cells(box.lo.y(), box.hi.y(), origin.y(), dp) : Range{0, 0};
  const Range z = cells(box.lo.z(), box.hi.z(), origin.z(), dp);
  const Index rows = y.size() * z.size();
  if (x.size() == 0 || rows == 0) return {};
  // One list per block of rows, joined in order: the same points for any number of threads.
  const int rows_per_block = static_cast<int>(std::clamp<Index>(4096 / x.size(), 1, 256));
  std::vector<std::vector<Vec3>> parts(
      static_cast<std::size_t>((rows + rows_per_block - 1) / rows_per_block));
  parallel_blocks(rows, rows_per_block, [&](Index begin, Index end, Index block) {
    std::vector<Vec3>& out = parts[static_cast<std::size_t>(block)];
    for (Index row = begin; row < end; ++row) {
      const auto centre = [&](Index k) {
        return Vec3(origin.x() + (static_cast<double>(k) + 0.5) * dp,
                    dim == 3
                        ? origin.y() + (static_cast<double>(y.first + row % y.size()) + 0.5) * dp
                        : 0.0,
                    origin.z() + (static_cast<double>(z.first + row / y.size()) + 0.5) * dp);
      };
      for (Index k = x.first; k <= x.last;) {
        const Verdict v = judge(centre(k));
        // The distance also decides for the next few points of the row.
        const auto more = static_cast<Index>(std::min(0.999 * v.holds / dp, 1e9));
        const Index stop = std::min(k + more, x.last);
        if (v.accept)
          for (Index i = k; i <= stop; ++i) out.push_back(centre(i));
        k = stop + 1;
      }
    }
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<Vec3> points;
  points.reserve(total);
  for (auto& part : parts) {
    points.insert(points.end(), part.begin(), part.end());
    part = {};
  }
  return points;
}

void refuse_absurd(double expected) {
  if (!(expected <= largest_fill))
    throw Error(
        ExitCode::usage,
        fmt::format("the shape would take about {:.3g} particles: is the resolution or a length "
                    "in the wrong unit?",
                    expected));
}

double volume(const Aabb& box, int dim) {
  const Vec3 size = (box.hi - box.lo).cwiseMax(0.0);
  return dim == 3 ? size.prod() : size.x() * size.z();
}

/// A lattice may be larger than the part that is used, as for thin shells.
constexpr double largest_lattice = 64.0 * largest_fill;

/// Points of the lattice in a box; at least one along each side, however thin the box is.
double lattice_points(const Aabb& box, double dp, int dim) {
  const Vec3 sides = ((box.hi - box.lo) / dp).cwiseMax(1.0);
  return dim == 3 ? sides.prod() : sides.x() * sides.z();
}

Vec3 default_origin(const Shape& shape, const Aabb& clip) {
  Vec3 origin = shape.box().lo;
  for (int k = 0; k < 3; ++k)
    if (!std::isfinite(origin[k])) origin[k] = clip.empty() ? 0.0 : clip.lo[k];
  return origin;
}

}  // namespace

namespace {

/// Volume (area in 2D) within `box`, on a coarse grid: share(d, reach) is how much of a cell whose
/// centre lies at the distance d counts, where the cell reaches from d - reach to d + reach.
double sampled_volume(const Aabb& box, int dim, const std::function<double(const Vec3&)>& distance,
                      const std::function<double(double d, double reach)>& share) {
  const int n = dim == 3 ? 16 : 64;
  const Vec3 cell = (box.hi - box.lo) / n;
  const double reach = 0.5 * (dim == 3 ? std::cbrt(cell.prod()) : std::sqrt(cell.x() * cell.z()));
  const Index rows = dim == 3 ? n * n : n;
  const double filled = ordered_sum(rows, [&](Index row) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      const Vec3 p = box.lo + cell.cwiseProduct(
                                  Vec3(i + 0.5, dim == 3 ? static_cast<double>(row % n) + 0.5 : 0.0,
                                       static_cast<double>(dim == 3 ? row / n : row) + 0.5));
      sum += share(distance(p), reach);
    }
    return sum;
  });
  return filled / static_cast<double>(rows * n) * volume(box, dim);
}

/// Share of [d - reach, d + reach] that lies in [from, to].
double overlap(double d, double reach, double from, double to) {
  if (!(reach > 0.0)) return d >= from && d < to ? 1.0 : 0.0;
  return std::max(0.0, std::min(d + reach, to) - std::max(d - reach, from)) / (2.0 * reach);
}

}  // namespace

double estimate_fill(const Shape& shape, double dp, int dim, const Aabb& clip) {
  const Aabb box = in_scene(clipped(shape.box(), clip), dim);
  if (box.empty()) return 0.0;
  if (!box.lo.allFinite() || !box.hi.allFinite()) return std::numeric_limits<double>::infinity();
  // A cell counts by the depth of its centre, so that thin bodies between centres are counted too.
  constexpr double deep = -std::numeric_limits<double>::max();
  return sampled_volume(
             box, dim, [&](const Vec3& p) { return shape.bound(p); },
             [](double d, double reach) { return overlap(d, reach, deep, 0.0); }) /
         std::pow(dp, dim);
}

double estimate_layers(const Shape& shape, double dp, int dim, double thickness, LayerSide side,
                       const Aabb& clip) {
  const bool outside = side == LayerSide::outside;
  const Aabb around = outside ? shape.box().grown(thickness) : shape.box();
  const Aabb box = in_scene(clipped(around, clip), dim);
  if (box.empty()) return 0.0;
  if (!box.lo.allFinite() || !box.hi.allFinite()) return std::numeric_limits<double>::infinity();
  const double sign = outside ? -1.0 : 1.0;
  return sampled_volume(
             box, dim,
             [&](const Vec3& p) {
               return sign * shape.bound(p);
             },  // exact ones of composed shapes are expensive
             [&](double d, double reach) { return overlap(d, reach, -thickness, 0.0); }) /
         std::pow(dp, dim);
}

std::vector<Vec3> fill_lattice(const Shape& shape, double dp, int dim, const Aabb& clip,
                               std::optional<Vec3> origin) {
  const Aabb box = in_scene(clipped(shape.box(), clip), dim);
  if (box.empty()) return {};
  refuse_unbounded(box);
  const double lattice = lattice_points(box, dp, dim);
  if (!(lattice <= largest_lattice)) refuse_absurd(lattice);
  if (lattice > largest_fill) refuse_absurd(estimate_fill(shape, dp, dim, clip));
  return collect(box, origin.value_or(default_origin(shape, clip)), dp, dim, [&](const Vec3& p) {
    const double d = shape.bound(p);
    if (std::abs(d) <= 1e-9 * dp) return Verdict{on_inner_seam(shape, p, 1e-4 * dp, dim == 2), 0.0};
    return Verdict{d < 0.0, std::abs(d)};
  });
}

FilledBox fill_box(const Box& shape, double dp, int dim) {
  const Aabb box = in_scene(shape.box(), dim);
  if (const double lattice = lattice_points(box, dp, dim); !(lattice <= largest_fill))
    refuse_absurd(lattice);
  FilledBox out;
  Index rows[3] = {1, 1, 1};
  Vec3 spacing = Vec3::Constant(dp);
  for (int k = 0; k < 3; ++k) {
    if (k == 1 && dim == 2) continue;
    const double cells = (box.hi[k] - box.lo[k]) / dp, whole = std::round(cells);
    rows[k] = static_cast<Index>(whole);
    if (rows[k] == 0) return out;
    // Round-off of a millionth of a row, as in fill_lattice.
    if (std::abs(cells - whole) > 1e-6) spacing[k] = (box.hi[k] - box.lo[k]) / whole;
    out.stretch = std::max(out.stretch, std::abs(spacing[k] / dp - 1));
  }
  out.volume =
      out.stretch > 0 ? (dim == 3 ? spacing.prod() : spacing.x() * spacing.z()) : std::pow(dp, dim);
  out.at.resize(static_cast<std::size_t>(rows[0] * rows[1] * rows[2]));
  parallel_for(static_cast<Index>(out.at.size()), [&](Index i) {
    const Index row[3] = {i % rows[0], i / rows[0] % rows[1], i / rows[0] / rows[1]};
    Vec3& p = out.at[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k)
      p[k] =
          k == 1 && dim == 2 ? 0.0 : box.lo[k] + (static_cast<double>(row[k]) + 0.5) * spacing[k];
  });
  return out;
}

double cut_volume(const Shape& shape, double dp, int dim) {
  const Aabb box = in_scene(shape.box().grown(dp), dim);
  refuse_unbounded(box);
  if (const double lattice = lattice_points(box, dp, dim); !(lattice <= largest_lattice))
    refuse_absurd(lattice);
  const Vec3 origin = default_origin(shape, {}) - Vec3::Constant(dp);
  const double reach = 0.5 * dp;
  double cells = 0;
  for (const Vec3& p : collect(box, origin, dp, dim, [&](const Vec3& at) {
         const double d = shape.bound(at);
         return Verdict{d < reach, std::max(std::abs(d) - reach, 0.0)};
       }))
    cells += std::clamp(0.5 - shape.signed_distance(p) / dp, 0.0, 1.0);
  return cells * std::pow(dp, dim);
}

std::vector<Vec3> fill_layers(const Shape& shape, double dp, int dim, double thickness,
                              LayerSide side, const Aabb& clip) {
  const bool outside = side == LayerSide::outside;
  const Aabb around = outside ? shape.box().grown(thickness) : shape.box();
  const Aabb box = in_scene(clipped(around, clip), dim);
  if (box.empty()) return {};
  refuse_unbounded(box);
  if (const double lattice = lattice_points(box, dp, dim); !(lattice <= largest_lattice))
    refuse_absurd(lattice);
  const double slack = 1e-9 * dp;
  const auto* plain_box = dynamic_cast<const Box*>(&shape);
  return collect(box, default_origin(shape, clip), dp, dim, [&](const Vec3& p) {
    double d = outside ? -shape.bound(p) : shape.bound(p);
    if (d >= -slack) return Verdict{false, std::max(d - slack, 0.0)};
    if (plain_box && outside) {
      // Measured across each face separately, so that the corners of a tank are closed.
      Vec3 out = (plain_box->min - p).cwiseMax(p - plain_box->max);
      if (dim == 2) out.y() = 0.0;
      d = -out.maxCoeff();
    } else if (shape.composed()) {
      // The bound decides for distant points at low cost; near the layer the true distance is
      // needed.
      if (-d >= thickness - slack) return Verdict{false, -d - thickness};
      d = outside ? -shape.signed_distance(p) : shape.signed_distance(p);
    }
    if (-d >= thickness - slack) return Verdict{false, std::max(-d - thickness, 0.0)};
    return Verdict{true, std::max(std::min(-d, thickness + d) - slack, 0.0)};
  });
}

}  // namespace sphgeo
