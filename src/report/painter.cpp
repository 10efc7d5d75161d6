#include "report/painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <unordered_map>

#include "core/hash.h"

namespace sphgeo {

namespace {

constexpr double margin = 6;  // pixels
constexpr float nothing = -std::numeric_limits<float>::infinity();
/// Discs below this size (pixels) are painted as squares, which leave no gaps.
constexpr double least_disc = 4;

}  // namespace

View view_of(const Aabb& box, int dimension, int most_width, int most_height) {
  if (box.empty() || !(box.hi - box.lo).allFinite())
    throw std::invalid_argument("a view of an empty or unbounded box");
  View view;
  view.flat = dimension == 2;
  if (!view.flat) {
    constexpr double azimuth = -60 * std::numbers::pi / 180,
                     elevation = 22 * std::numbers::pi / 180;
    view.right = Vec3(-std::sin(azimuth), std::cos(azimuth), 0);
    view.toward = Vec3(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    view.up = view.toward.cross(view.right);
  }
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? box.hi.x() : box.lo.x(), corner & 2 ? box.hi.y() : box.lo.y(),
                 corner & 4 ? box.hi.z() : box.lo.z());
    x0 = std::min(x0, p.dot(view.right));
    x1 = std::max(x1, p.dot(view.right));
    y0 = std::min(y0, p.dot(view.up));
    y1 = std::max(y1, p.dot(view.up));
  }
  const double wide = std::max(x1 - x0, 1e-300), high = std::max(y1 - y0, 1e-300);
  view.scale = std::min((most_width - 2 * margin) / wide, (most_height - 2 * margin) / high);
  view.width =
      std::clamp(static_cast<int>(std::lround(wide * view.scale + 2 * margin)), 16, most_width);
  view.height =
      std::clamp(static_cast<int>(std::lround(high * view.scale + 2 * margin)), 16, most_height);
  view.left = (x0 + x1) / 2 - view.width / (2 * view.scale);
  view.top = (y0 + y1) / 2 + view.height / (2 * view.scale);
  return view;
}

Aabb picture_box(const Aabb& particles, const Aabb& walls, double reach) {
  if (particles.empty() || walls.empty()) return particles.empty() ? walls : particles;
  Aabb box = particles;
  const Vec3 most = Vec3::Constant(reach * (box.hi - box.lo).maxCoeff());
  box.lo = box.lo.cwiseMin(walls.lo.cwiseMax(box.lo - most));
  box.hi = box.hi.cwiseMax(walls.hi.cwiseMin(box.hi + most));
  return box;
}

double disc_cover(const View& view, double spacing) {
  if (!view.flat) return 1.25;
  return spacing * view.scale < 9 ? 1.42 : 1.08;
}

Painter::Painter(const View& view, std::vector<Color> colors)
    : view_(view), colors_(std::move(colors)) {
  if (colors_.empty() || colors_.size() > most_colors)
    throw std::invalid_argument("a painter of no or too many colours");
  const auto n = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  color_.assign(n, -1);
  above_.assign(n, -1);
  if (!view.flat) {
    depth_.assign(n, nothing);
    light_.assign(n, 1);
  }
}

void Painter::set(int column, int row, int color) {
  if (column < 0 || row < 0 || column >= view_.width || row >= view_.height) return;
  const auto k = static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
                 static_cast<std::size_t>(column);
  if (!view_.flat && depth_[k] != nothing) return;  // a line behind a disc
  color_[k] = static_cast<std::int16_t>(color);
}

void Painter::line(const Vec3& a, const Vec3& b, double thickness, int color) {
  double x0 = view_.column(a), y0 = view_.row(a), x1 = view_.column(b), y1 = view_.row(b);
  if (!(std::isfinite(x0) && std::isfinite(y0) && std::isfinite(x1) && std::isfinite(y1))) return;
  // Only the part in the picture: a wall may be kilometres long (clipping after Liang and Barsky).
  double from = 0, to = 1;
  const double pad = thickness + 1;
  for (const auto& [p, d, low, high] : {std::array{x0, x1 - x0, -pad, view_.width + pad},
                                        std::array{y0, y1 - y0, -pad, view_.height + pad}}) {
    if (d == 0 && (p < low || p > high)) return;
    if (d == 0) continue;
    from = std::max(from, std::min((low - p) / d, (high - p) / d));
    to = std::min(to, std::max((low - p) / d, (high - p) / d));
  }
  if (from > to) return;
  const double dx = x1 - x0, dy = y1 - y0;
  x1 = x0 + to * dx;
  y1 = y0 + to * dy;
  x0 += from * dx;
  y0 += from * dy;
  const double length = std::hypot(x1 - x0, y1 - y0);
  const int steps = static_cast<int>(std::ceil(2 * length)) + 1;
  const int half = static_cast<int>(std::ceil(thickness / 2));
  for (int s = 0; s <= steps; ++s) {
    const double f = static_cast<double>(s) / steps, x = x0 + f * (x1 - x0), y = y0 + f * (y1 - y0);
    for (int row = static_cast<int>(std::floor(y)) - half;
         row <= static_cast<int>(std::floor(y)) + half; ++row)
      for (int column = static_cast<int>(std::floor(x)) - half;
           column <= static_cast<int>(std::floor(x)) + half; ++column)
        if (std::max(std::abs(column + 0.5 - x), std::abs(row + 0.5 - y)) <= thickness / 2)
          set(column, row, color);
  }
}

void Painter::discs(std::span<const Vec3> centers, double diameter,
                    std::span<const std::uint8_t> colors, double nearer) {
  if (colors.size() != centers.size()) throw std::invalid_argument("a disc without a colour");
  ball_ = std::max(ball_, diameter);
  const double radius = std::max(0.5 * diameter * view_.scale, 0.75);
  const bool square = 2 * radius < least_disc;
  const double reach = square ? std::max(radius, 0.71) : radius;
  const Vec3 sun = Vec3(-0.45, 0.6, 0.66).normalized();  // right, up, to the eye
  for (std::size_t i = 0; i < centers.size(); ++i) {
    if (!centers[i].allFinite()) continue;
    const double x = view_.column(centers[i]), y = view_.row(centers[i]);
    if (!(x > -reach && y > -reach && x < view_.width + reach && y < view_.height + reach))
      continue;
    const double depth = centers[i].dot(view_.toward) + nearer;
    const int c0 = std::max(0, static_cast<int>(std::ceil(x - reach - 0.5))),
              c1 = std::min(view_.width - 1, static_cast<int>(std::floor(x + reach - 0.5)));
    const int r0 = std::max(0, static_cast<int>(std::ceil(y - reach - 0.5))),
              r1 = std::min(view_.height - 1, static_cast<int>(std::floor(y + reach - 0.5)));
    for (int row = r0; row <= r1; ++row)
      for (int column = c0; column <= c1; ++column) {
        const double dx = (column + 0.5 - x) / radius, dy = (row + 0.5 - y) / radius,
                     rest = 1 - dx * dx - dy * dy;
        if (!square && rest < 0) continue;
        const auto k = static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
                       static_cast<std::size_t>(column);
        if (!view_.flat) {
          const double h = square ? 0 : std::sqrt(rest);
          const auto z = static_cast<float>(depth + 0.5 * diameter * h);
          if (z <= depth_[k]) continue;
          depth_[k] = z;
          light_[k] =
              square ? 1.0f
                     : static_cast<float>(0.62 + 0.38 * std::max(0.0, sun.dot(Vec3(dx, -dy, h))));
        }
        color_[k] = colors[i];
      }
  }
}

void Painter::mark(const Vec3& at, double radius, int color) {
  const double x = view_.column(at), y = view_.row(at);
  if (!std::isfinite(x) || !std::isfinite(y) || std::max(std::abs(x), std::abs(y)) > 1e6) return;
  const int reach = static_cast<int>(std::ceil(radius)) + 1, cx = static_cast<int>(std::floor(x)),
            cy = static_cast<int>(std::floor(y));
  for (int row = std::max(0, cy - reach); row <= std::min(view_.height - 1, cy + reach); ++row)
    for (int column = std::max(0, cx - reach); column <= std::min(view_.width - 1, cx + reach);
         ++column) {
      const double d = std::hypot(column + 0.5 - x, row + 0.5 - y);
      if (std::abs(d - radius + 1) > 1 && d > 1.6) continue;
      above_[static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
             static_cast<std::size_t>(column)] = static_cast<std::int16_t>(color);
    }
}

/// Shading by the light on the ball and by neighbouring pixels in front of this one: edges of
/// nearer particles are outlined by a dark rim.
int Painter::shade_at(int column, int row) const {
  const auto index = [&](int c, int r) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(view_.width) +
           static_cast<std::size_t>(c);
  };
  const std::size_t k = index(column, row);
  double shadow = 0;
  for (const auto& [dc, dr] :
       {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-2, -2}, {2, -2}, {-2, 2}, {2, 2}}) {
    const int c = column + dc, r = row + dr;
    if (c < 0 || r < 0 || c >= view_.width || r >= view_.height || depth_[index(c, r)] == nothing)
      continue;
    shadow += std::clamp((depth_[index(c, r)] - depth_[k]) / ball_ - 0.5, 0.0, 3.0);
  }
  const double light = light_[k] * std::exp(-0.07 * shadow);
  return std::clamp(static_cast<int>(std::lround((shades - 1) * (light - 0.3) / 0.7)), 0,
                    shades - 1);
}

Picture Painter::picture() const {
  Picture p;
  p.width = view_.width;
  p.height = view_.height;
  p.palette.push_back({0, 0, 0, 0});
  const int each = view_.flat ? 1 : shades;
  for (const Color& c : colors_)
    for (int s = 0; s < each; ++s) {
      const double light = each == 1 ? 1 : 0.42 + 0.58 * s / (shades - 1);
      p.palette.push_back({c.r * light, c.g * light, c.b * light, c.a});
    }
  p.pixels.reserve(color_.size());
  for (int row = 0; row < view_.height; ++row)
    for (int column = 0; column < view_.width; ++column) {
      const auto k = static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.width) +
                     static_cast<std::size_t>(column);
      const int color = above_[k] >= 0 ? above_[k] : color_[k];
      if (color < 0) {
        p.pixels.push_back(0);
        continue;
      }
      const bool ball = !view_.flat && above_[k] < 0 && depth_[k] != nothing;
      p.pixels.push_back(static_cast<std::uint8_t>(1 + color * each +
                                                   (each == 1 ? 0
                                                    : ball    ? shade_at(column, row)
                                                              : each - 1)));
    }
  return p;
}

std::vector<std::pair<Index, Index>> outline(std::span<const Vec3> points, int corners_per_cell,
                                             std::span<const Index> corners) {
  std::vector<std::pair<Index, Index>> lines;
  if (corners_per_cell == 2)
    for (std::size_t i = 0; i + 1 < corners.size(); i += 2)
      lines.emplace_back(corners[i], corners[i + 1]);
  if (corners_per_cell != 3) return lines;
  const std::size_t triangles = corners.size() / 3;
  // A surface that was cut from a grid repeats points, and has faces without area between them:
  // equal places are one corner.
  const auto hash = [](const Vec3& p) {
    std::uint64_t bits = 0;
    for (const double c : p)
      bits = random_bits(bits, std::bit_cast<std::uint64_t>(c + 0.0));  // -0 is 0
    return bits;
  };
  std::unordered_map<Vec3, Index, decltype(hash)> corner_at(2 * points.size(), hash);
  std::vector<Index> same(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    same[i] = corner_at.try_emplace(points[i], static_cast<Index>(i)).first->second;
  std::vector<Vec3> normals(triangles);
  const auto corner = [&](std::size_t t, std::size_t k) {
    return same[static_cast<std::size_t>(corners[3 * t + k % 3])];
  };
  const auto lower = [&](std::size_t t, std::size_t k) {
    return static_cast<std::size_t>(std::min(corner(t, k), corner(t, k + 1)));
  };
  // The sides of all faces, sorted by the lower of their two corners: those of one corner are few.
  std::vector<std::size_t> begin(points.size() + 1, 0);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto corner_point = [&](std::size_t k) {
      return points[static_cast<std::size_t>(corner(t, k))];
    };
    normals[t] = (corner_point(1) - corner_point(0)).cross(corner_point(2) - corner_point(0));
    if (!(normals[t].norm() > 0)) continue;
    normals[t].normalize();
    for (std::size_t k = 0; k < 3; ++k) ++begin[lower(t, k) + 1];
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  struct Side {
    Index to;
    std::size_t face;
  };
  std::vector<Side> sides(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t k = 0; k < 3 && normals[t].norm() > 0; ++k)
      sides[next[lower(t, k)]++] = {std::max(corner(t, k), corner(t, k + 1)), t};
  const double sharp = std::cos(30 * std::numbers::pi / 180);
  for (std::size_t from = 0; from < points.size(); ++from) {
    const auto first = sides.begin() + static_cast<long>(begin[from]),
               last = sides.begin() + static_cast<long>(begin[from + 1]);
    std::sort(first, last, [](const Side& a, const Side& b) {
      return std::pair(a.to, a.face) < std::pair(b.to, b.face);
    });
    for (auto side = first; side != last;) {
      auto end = side;
      bool bent = false;
      for (; end != last && end->to == side->to; ++end)
        bent = bent || normals[end->face].dot(normals[side->face]) < sharp;
      if (end - side == 1 || bent) lines.emplace_back(static_cast<Index>(from), side->to);
      side = end;
    }
  }
  return lines;
}

}  // namespace sphgeo
