#include <algorithm>
#include <cmath>

#include "core/csv_table.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, HeightField> registered_height_field{"height_field"};
}

Schema<HeightField> HeightField::schema() {
  Schema<HeightField> s("height_field",
                        "Terrain: solid below a bilinear surface through a grid of heights, with "
                        "vertical sides at the edge of the grid.");
  s.optional(
      "file", &HeightField::file, unit::none,
      "CSV of numbers only: each row runs along x, row after row along y; # begins a comment.");
  s.optional("heights", &HeightField::heights, unit::length,
             "The heights, row by row, instead of a file.");
  s.optional("columns", &HeightField::columns, unit::none,
             "Heights in a row of `heights`; 0: all of them are one row.")
      .at_least(0);
  s.required("spacing", &HeightField::spacing, unit::length, "Distance of the heights along x.")
      .above(0);
  s.optional("spacing_y", &HeightField::spacing_y, unit::length,
             "Distance of the rows along y; auto: as along x.")
      .above(0);
  s.optional("origin", &HeightField::origin, unit::length,
             "Position of the first height of the first row; its z is added to all heights.")
      .keep_y();
  s.optional("scale", &HeightField::scale, unit::none,
             "Factor on the heights, before the origin's z.");
  s.optional("bottom", &HeightField::bottom, unit::length,
             "Underside of the solid; auto: unbounded.");
  s.optional("section", &HeightField::section, unit::length, "The y of the section in a 2D scene.");
  s.check([](HeightField& h, CheckContext& c) {
    set_scene(h, c);
    if (h.file.has_value() == !h.heights.empty())
      return c.error("", "a height field needs either `file` or `heights`",
                     h.file ? "leave one of them out" : "give one of them");
    prepare_or_report(h, c, h.file ? "file" : "heights");
  });
  return s;
}

void HeightField::prepare() {
  const std::string where = file ? file->path : "heights";
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::usage, where + ": " + what);
  };
  constexpr double longest = 1e12;  // m; products of four lengths stay in the range of a double
  std::size_t nx = 0, ny = 0;
  if (file) {
    const CsvTable table = read_csv_table(file->path);
    nx = table.names().size();
    ny = table.rows();
    grid_.assign(nx * ny, 0.0);
    for (std::size_t i = 0; i < nx; ++i) {
      const std::vector<double> column = table.numbers(table.names()[i]);
      for (std::size_t j = 0; j < ny; ++j) grid_[j * nx + i] = column[j];
    }
  } else {
    nx = columns > 0 ? static_cast<std::size_t>(columns) : heights.size();
    if (nx == 0 || heights.size() % nx != 0)
      fail(std::to_string(heights.size()) + " heights do not fill rows of " + std::to_string(nx));
    ny = heights.size() / nx;
    grid_ = heights;
  }
  if (ny < 1) fail("no row of heights is given");
  if (nx < 2) fail("at least two heights in a row are needed");
  for (double& v : grid_) {
    if (!std::isfinite(v)) fail("a height is missing or not finite");
    v = scale * v + origin.z();
    if (!(std::abs(v) <= longest)) fail("a height of " + exact(v) + " m: is `scale` right?");
  }
  const double end =
      std::max(std::abs(origin.x()) + static_cast<double>(nx) * spacing,
               std::abs(origin.y()) + static_cast<double>(ny) * spacing_y.value_or(spacing));
  if (!(end <= longest)) fail("the terrain reaches " + exact(end) + " m: is `spacing` right?");
  nx_ = static_cast<int>(nx);
  ny_ = static_cast<int>(ny);
  dy_ = spacing_y.value_or(spacing);
  if (flat && ny_ > 1) {
    // The bilinear surface cut at constant y is a polyline over the columns.
    std::vector<double> row(nx);
    for (int i = 0; i < nx_; ++i)
      row[static_cast<std::size_t>(i)] = height(origin.x() + i * spacing, section);
    grid_ = std::move(row);
    ny_ = 1;
  }
  const auto [low, high] = std::minmax_element(grid_.begin(), grid_.end());
  if (bottom && *bottom >= *low)
    fail("`bottom` must lie below the lowest height (" + std::to_string(*low) + " m)");
  lo_ = {origin.x(), ny_ > 1 ? origin.y() : 0.0, *low};
  hi_ = {origin.x() + (nx_ - 1) * spacing, ny_ > 1 ? origin.y() + (ny_ - 1) * dy_ : 0.0, *high};
  std::vector<Aabb> boxes;
  for (int j = 0; j < std::max(ny_ - 1, 1); ++j)
    for (int i = 0; i + 1 < nx_; ++i) {
      Aabb b;
      for (int k = 0; k < (ny_ > 1 ? 4 : 2); ++k) {
        const int ii = i + k % 2, jj = j + k / 2;
        b.extend(
            Vec3(origin.x() + ii * spacing, ny_ > 1 ? origin.y() + jj * dy_ : 0.0, node(ii, jj)));
      }
      boxes.push_back(b);
    }
  tree_ = BoxTree(boxes);
}

double HeightField::node(int i, int j) const {
  return grid_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) +
               static_cast<std::size_t>(i)];
}

double HeightField::height(double x, double y) const {
  const double u = std::clamp((x - origin.x()) / spacing, 0.0, nx_ - 1.0);
  const int i = std::min(static_cast<int>(u), nx_ - 2);
  const double a = u - i;
  if (ny_ == 1) return (1.0 - a) * node(i, 0) + a * node(i + 1, 0);
  const double v = std::clamp((y - origin.y()) / dy_, 0.0, ny_ - 1.0);
  const int j = std::min(static_cast<int>(v), ny_ - 2);
  const double b = v - j;
  return (1.0 - b) * ((1.0 - a) * node(i, j) + a * node(i + 1, j)) +
         b * ((1.0 - a) * node(i, j + 1) + a * node(i + 1, j + 1));
}

double HeightField::patch_distance_squared(const Vec3& p, std::int32_t cell, double best) const {
  const int i = cell % (nx_ - 1), j = cell / (nx_ - 1);
  const double x0 = origin.x() + i * spacing;
  if (ny_ == 1) {
    const double d =
        segment_distance(p, {x0, 0.0, node(i, 0)}, {x0 + spacing, 0.0, node(i + 1, 0)});
    return d * d;
  }
  const double y0 = origin.y() + j * dy_;
  // z = c0 + cu u + cv v + cuv u v over the unit square; Gauss-Newton on the squared distance with
  // the twist kept, clamped to the square. Any (u, v) is on the patch, so the best seen is safe.
  const double c0 = node(i, j), cu = node(i + 1, j) - c0, cv = node(i, j + 1) - c0;
  const double cuv = node(i + 1, j + 1) - c0 - cu - cv;
  // Without its twist the patch is a part of a plane, no farther than w from it. Far from the
  // ground this decides for almost all patches.
  {
    const double zu = cu + 0.5 * cuv, zv = cv + 0.5 * cuv, w = 0.25 * std::abs(cuv);
    const double fall =
        c0 - 0.25 * cuv + zu * (p.x() - x0) / spacing + zv * (p.y() - y0) / dy_ - p.z();
    // Foot of the perpendicular on the plane, in (u, v), and how far it is outside of the square,
    // m.
    const double su = zu / spacing, sv = zv / dy_, drop = fall / (1.0 + su * su + sv * sv);
    const double foot_u = (p.x() - su * drop - x0) / spacing,
                 foot_v = (p.y() - sv * drop - y0) / dy_;
    const double out_u = spacing * std::max({0.0, -foot_u, foot_u - 1.0}),
                 out_v = dy_ * std::max({0.0, -foot_v, foot_v - 1.0});
    const double least = std::sqrt(fall * drop + out_u * out_u + out_v * out_v) - w;
    if (least > 0.0 && least * least > best) return std::numeric_limits<double>::infinity();
  }
  double u = std::clamp((p.x() - x0) / spacing, 0.0, 1.0);
  double v = std::clamp((p.y() - y0) / dy_, 0.0, 1.0);
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 12; ++k) {
    const double rx = x0 + u * spacing - p.x(), ry = y0 + v * dy_ - p.y();
    const double rz = c0 + cu * u + cv * v + cuv * u * v - p.z();
    const double d2 = rx * rx + ry * ry + rz * rz;
    if (d2 >= best2 * (1.0 - 1e-13)) break;
    best2 = d2;
    const double zu = cu + cuv * v, zv = cv + cuv * u;
    const double gu = rx * spacing + rz * zu, gv = ry * dy_ + rz * zv;
    const double huu = spacing * spacing + zu * zu, hvv = dy_ * dy_ + zv * zv;
    double huv = zu * zv + rz * cuv;
    double det = huu * hvv - huv * huv;
    if (det <=
        0.01 * huu * hvv) {  // far from the surface the twist may make the Hessian indefinite
      huv = zu * zv;
      det = huu * hvv - huv * huv;
    }
    u = std::clamp(u - (hvv * gu - huv * gv) / det, 0.0, 1.0);
    v = std::clamp(v - (huu * gv - huv * gu) / det, 0.0, 1.0);
  }
  // A clamped Newton step may stop short on an edge; the four edges are straight and exact. Inside,
  // the search has converged.
  if (u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0) return best2;
  const Vec3 a{x0, y0, c0}, b{x0 + spacing, y0, node(i + 1, j)}, c{x0, y0 + dy_, node(i, j + 1)},
      d{x0 + spacing, y0 + dy_, node(i + 1, j + 1)};
  const double edge = std::min({segment_distance(p, a, b), segment_distance(p, c, d),
                                segment_distance(p, a, c), segment_distance(p, b, d)});
  return std::min(best2, edge * edge);
}

double HeightField::signed_distance(const Vec3& at) const {
  const Vec3 p{at.x(), ny_ == 1 ? 0.0 : at.y(), at.z()};
  const Vec3 nearest = p.cwiseMax(lo_).cwiseMin(hi_);
  double side =
      std::max(lo_.x() - p.x(), p.x() - hi_.x());  // signed distance to the vertical sides
  double out = std::max(side, 0.0);
  if (ny_ > 1) {
    const double side_y = std::max(lo_.y() - p.y(), p.y() - hi_.y());
    out = std::hypot(out, std::max(side_y, 0.0));
    side = std::max(side, side_y);
  }
  if (out > 0.0) side = out;
  const double above = p.z() - height(nearest.x(), nearest.y());
  const double under = bottom ? *bottom - p.z() : -std::numeric_limits<double>::infinity();
  // Beside the sides or below the underside the top surface is not needed.
  if (above <= 0.0 && (side > 0.0 || under > 0.0)) return extruded_distance(side, under);
  const double start = out > 0.0 ? std::numeric_limits<double>::infinity() : above * above;
  double best = start;
  const double top = std::sqrt(tree_.nearest(p, start, [&](std::int32_t cell) {
    const double d2 = patch_distance_squared(p, cell, best);
    best = std::min(best, d2);
    return d2;
  }));
  return above > 0.0 ? top : std::max({-top, side, under});
}

Aabb HeightField::box() const {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Aabb b{lo_, hi_};
  b.lo.z() = bottom.value_or(-inf);
  if (ny_ == 1) {
    b.lo.y() = -inf;
    b.hi.y() = inf;
  }
  return seen(b);
}

}  // namespace sphgeo
