#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "geometry/scene_check.h"
#include "geometry/shapes.h"
#include "geometry/terrain_file.h"

namespace sphgeo {

namespace {
const Register<Shape, HeightField> registered_height_field{"height_field"};
}

Schema<HeightField> HeightField::schema() {
  Schema<HeightField> s("height_field",
                        "Terrain: solid below a bilinear surface through a grid of heights, with "
                        "vertical sides at the edge of the grid.");
  s.optional("file", &HeightField::file, unit::none,
             "A table of numbers only, each row along x, row after row along y; or of points with "
             "the columns x, y, z that lie on a grid; or an ESRI ASCII grid.");
  s.optional("format", &HeightField::format, unit::none,
             "Which of them the file is; auto: by its contents.")
      .choices({"auto", "grid", "points", "esri"});
  s.optional("no_data", &HeightField::no_data, unit::none,
             "The number in the file that means no height is known; auto: what its header says, "
             "and -9999, -32768 and 3.4e38 of either sign.");
  s.optional("holes", &HeightField::holes, unit::none,
             "What to do where no height is known: refuse the file, or fill holes by the smooth "
             "surface through the heights around them.")
      .choices({"refuse", "fill"});
  s.optional("heights", &HeightField::heights, unit::length,
             "The heights, row by row, instead of a file.");
  s.optional("columns", &HeightField::columns, unit::none,
             "Heights in a row of `heights`; 0: all of them are one row.")
      .at_least(0);
  s.optional("spacing", &HeightField::spacing, unit::length,
             "Distance of the heights along x; auto: what the file says.")
      .above(0);
  s.optional("spacing_y", &HeightField::spacing_y, unit::length,
             "Distance of the rows along y; auto: as along x.")
      .above(0);
  s.optional("origin", &HeightField::origin, unit::length,
             "Position of the first height of the first row, or what is added to the coordinates "
             "in the file; its z is added to all heights.")
      .keep_y();
  s.optional("map_origin", &HeightField::map_origin, unit::length,
             "The point of the file's coordinates that becomes [0, 0, 0] of the scene.")
      .keep_y();
  s.optional("scale", &HeightField::scale, unit::none,
             "Factor on the heights, before any origin's z.");
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
  TerrainGrid grid;
  if (file) {
    grid = read_terrain(file->path, format, no_data);
  } else {
    const auto nx = columns > 0 ? static_cast<std::size_t>(columns) : heights.size();
    if (nx == 0 || heights.size() % nx != 0)
      throw Error(ExitCode::usage,
                  fmt::format("{}: {} heights do not fill rows of {}", where, heights.size(), nx));
    grid.nx = static_cast<int>(nx);
    grid.ny = static_cast<int>(heights.size() / nx);
    grid.heights = heights;
  }
  place(grid, where);
  const auto nx = static_cast<std::size_t>(nx_);
  if (flat && ny_ > 1) {
    const double end = y0_ + (ny_ - 1) * dy_, slack = 1e-6 * dy_;
    if (section < y0_ - slack || section > end + slack)
      throw Error(
          ExitCode::usage,
          fmt::format("{}: the section at y = {} m lies outside of the terrain, which has y "
                      "from {} to {} m: give `section`",
                      where, exact(section), exact(y0_), exact(end)));
    // The bilinear surface cut at constant y is a polyline over the columns.
    std::vector<double> row(nx);
    for (int i = 0; i < nx_; ++i)
      row[static_cast<std::size_t>(i)] = surface(x0_ + i * dx_, section);
    grid_ = std::move(row);
    ny_ = 1;
  }
  const auto [low, high] = std::minmax_element(grid_.begin(), grid_.end());
  if (bottom && *bottom >= *low)
    throw Error(ExitCode::usage,
                fmt::format("{}: `bottom` must lie below the lowest height ({} m)", where, *low));
  lo_ = {x0_, ny_ > 1 ? y0_ : 0.0, *low};
  hi_ = {x0_ + (nx_ - 1) * dx_, ny_ > 1 ? y0_ + (ny_ - 1) * dy_ : 0.0, *high};
  std::vector<Aabb> boxes;
  for (int j = 0; j < std::max(ny_ - 1, 1); ++j)
    for (int i = 0; i + 1 < nx_; ++i) {
      Aabb b;
      for (int k = 0; k < (ny_ > 1 ? 4 : 2); ++k) {
        const int ii = i + k % 2, jj = j + k / 2;
        b.extend(Vec3(x0_ + ii * dx_, ny_ > 1 ? y0_ + jj * dy_ : 0.0, node(ii, jj)));
      }
      boxes.push_back(b);
    }
  tree_ = BoxTree(boxes);
}

// Holes, units and origins: from what the file says to heights in the scene.
void HeightField::place(const TerrainGrid& from, const std::string& where) {
  const auto fail = [&](const std::string& what) {
    throw Error(ExitCode::usage, where + ": " + what);
  };
  constexpr double longest = 1e12;  // m; products of four lengths stay in the range of a double
  TerrainGrid grid = from;
  if (grid.ny < 1) fail("no row of heights is given");
  along_y_ = grid.placed && grid.nx == 1 && grid.ny > 1;
  if (along_y_ && flat)
    fail("the heights stand on one line along y, of which a 2D scene in x and z sees one point");
  if (grid.nx < 2 && !along_y_) fail("at least two heights in a row are needed");
  if (grid.placed) {
    // The deck may know better what the digits of the file have rounded.
    const auto take = [&](const std::optional<double>& said, double& step, int lines) {
      if (!said || lines < 2) return true;
      if (!(std::abs(*said - step) <= 1e-6 * step + grid.slack)) return false;
      step = *said;
      return true;
    };
    const double dx = grid.dx, dy = grid.dy;
    if (!take(spacing, grid.dx, grid.nx) ||
        !take(spacing_y ? spacing_y : spacing, grid.dy, grid.ny))
      fail(
          fmt::format("the heights of the file are {} m by {} m apart, the deck says otherwise: "
                      "leave `spacing` out",
                      exact(dx), exact(dy)));
  } else if (!spacing) {
    fail("`spacing` is missing: numbers alone do not say how far apart the heights are");
  } else {
    grid.dx = *spacing;
    grid.dy = spacing_y.value_or(*spacing);
  }
  nx_ = grid.nx;
  ny_ = grid.ny;
  dx_ = grid.dx;
  dy_ = grid.dy;
  x0_ = grid.x - map_origin.x() + origin.x();
  y0_ = grid.y - map_origin.y() + origin.y();
  const auto missing = std::find_if(grid.heights.begin(), grid.heights.end(),
                                    [](double z) { return std::isnan(z); });
  filled_ = 0;
  if (missing != grid.heights.end()) {
    const auto count =
        std::count_if(missing, grid.heights.end(), [](double z) { return std::isnan(z); });
    const auto first = static_cast<int>(missing - grid.heights.begin());
    if (static_cast<std::size_t>(count) == grid.heights.size()) fail("no height is known");
    if (holes == "refuse")
      fail(fmt::format(
          "{} of {} heights are missing, the first at x = {:.6g}, y = {:.6g} m; say `holes: "
          "fill` to fill them from the heights around, or crop the file",
          count, grid.heights.size(), x0_ + first % nx_ * dx_, y0_ + first / nx_ * dy_));
    filled_ = fill_holes(grid);
  }
  grid_ = std::move(grid.heights);
  for (double& v : grid_) {
    if (!std::isfinite(v)) fail("a height is not finite");
    v = scale * v - map_origin.z() + origin.z();
    if (!(std::abs(v) <= longest)) fail("a height of " + exact(v) + " m: is `scale` right?");
  }
  if (!std::isfinite(x0_) || !std::isfinite(y0_)) fail("the coordinates are not finite");
  const double reach = std::max({std::abs(x0_), std::abs(y0_), std::abs(x0_ + nx_ * dx_),
                                 std::abs(y0_ + ny_ * dy_)}),
               extent = std::hypot(nx_ * dx_, ny_ * dy_);
  if (grid.placed && reach > 1000 * extent)
    fail(
        fmt::format("the terrain is {:.4g} m across and lies at x = {}, y = {} m: coordinates of a "
                    "map? `map_origin: [{}, {}, 0]` moves its first height to the origin",
                    extent, exact(x0_), exact(y0_), exact(grid.x), exact(grid.y)));
  if (!(reach <= longest)) fail("the terrain reaches " + exact(reach) + " m: is `spacing` right?");
  if (along_y_) {
    std::swap(nx_, ny_);
    std::swap(dx_, dy_);
    std::swap(x0_, y0_);
  }
}

void HeightField::inspect(CheckContext& context) const {
  if (filled_ > 0)
    context.warning("file", fmt::format("{} heights are missing and were filled from those around "
                                        "them",
                                        filled_));
}

double HeightField::node(int i, int j) const {
  return grid_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) +
               static_cast<std::size_t>(i)];
}

double HeightField::height(double x, double y) const {
  return along_y_ ? surface(y, x) : surface(x, y);
}

double HeightField::surface(double x, double y) const {
  const double u = std::clamp((x - x0_) / dx_, 0.0, nx_ - 1.0);
  const int i = std::min(static_cast<int>(u), nx_ - 2);
  const double a = u - i;
  if (ny_ == 1) return (1.0 - a) * node(i, 0) + a * node(i + 1, 0);
  const double v = std::clamp((y - y0_) / dy_, 0.0, ny_ - 1.0);
  const int j = std::min(static_cast<int>(v), ny_ - 2);
  const double b = v - j;
  return (1.0 - b) * ((1.0 - a) * node(i, j) + a * node(i + 1, j)) +
         b * ((1.0 - a) * node(i, j + 1) + a * node(i + 1, j + 1));
}

double HeightField::patch_distance_squared(const Vec3& p, std::int32_t cell, double best) const {
  const int i = cell % (nx_ - 1), j = cell / (nx_ - 1);
  const double x0 = x0_ + i * dx_;
  if (ny_ == 1) {
    const double d = segment_distance(p, {x0, 0.0, node(i, 0)}, {x0 + dx_, 0.0, node(i + 1, 0)});
    return d * d;
  }
  const double y0 = y0_ + j * dy_;
  // z = c0 + cu u + cv v + cuv u v over the unit square; Gauss-Newton on the squared distance with
  // the twist kept, clamped to the square. Any (u, v) is on the patch, so the best seen is safe.
  const double c0 = node(i, j), cu = node(i + 1, j) - c0, cv = node(i, j + 1) - c0;
  const double cuv = node(i + 1, j + 1) - c0 - cu - cv;
  // Without its twist the patch is a part of a plane, no farther than w from it. Far from the
  // ground this decides for almost all patches.
  {
    const double zu = cu + 0.5 * cuv, zv = cv + 0.5 * cuv, w = 0.25 * std::abs(cuv);
    const double fall = c0 - 0.25 * cuv + zu * (p.x() - x0) / dx_ + zv * (p.y() - y0) / dy_ - p.z();
    // Foot of the perpendicular on the plane, in (u, v), and how far it is outside of the square,
    // m.
    const double su = zu / dx_, sv = zv / dy_, drop = fall / (1.0 + su * su + sv * sv);
    const double foot_u = (p.x() - su * drop - x0) / dx_, foot_v = (p.y() - sv * drop - y0) / dy_;
    const double out_u = dx_ * std::max({0.0, -foot_u, foot_u - 1.0}),
                 out_v = dy_ * std::max({0.0, -foot_v, foot_v - 1.0});
    const double least = std::sqrt(fall * drop + out_u * out_u + out_v * out_v) - w;
    if (least > 0.0 && least * least > best) return std::numeric_limits<double>::infinity();
  }
  double u = std::clamp((p.x() - x0) / dx_, 0.0, 1.0);
  double v = std::clamp((p.y() - y0) / dy_, 0.0, 1.0);
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 12; ++k) {
    const double rx = x0 + u * dx_ - p.x(), ry = y0 + v * dy_ - p.y();
    const double rz = c0 + cu * u + cv * v + cuv * u * v - p.z();
    const double d2 = rx * rx + ry * ry + rz * rz;
    if (d2 >= best2 * (1.0 - 1e-13)) break;
    best2 = d2;
    const double zu = cu + cuv * v, zv = cv + cuv * u;
    const double gu = rx * dx_ + rz * zu, gv = ry * dy_ + rz * zv;
    const double huu = dx_ * dx_ + zu * zu, hvv = dy_ * dy_ + zv * zv;
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
  const Vec3 a{x0, y0, c0}, b{x0 + dx_, y0, node(i + 1, j)}, c{x0, y0 + dy_, node(i, j + 1)},
      d{x0 + dx_, y0 + dy_, node(i + 1, j + 1)};
  const double edge = std::min({segment_distance(p, a, b), segment_distance(p, c, d),
                                segment_distance(p, a, c), segment_distance(p, b, d)});
  return std::min(best2, edge * edge);
}

double HeightField::signed_distance(const Vec3& at) const {
  const Vec3 p{along_y_ ? at.y() : at.x(), ny_ == 1 ? 0.0 : at.y(), at.z()};
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
  const double above = p.z() - surface(nearest.x(), nearest.y());
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
  if (along_y_) {
    std::swap(b.lo.x(), b.lo.y());
    std::swap(b.hi.x(), b.hi.y());
  }
  return seen(b);
}

}  // namespace sphgeo
