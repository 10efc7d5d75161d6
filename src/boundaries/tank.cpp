#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "boundaries/boundary.h"
#include "core/parallel.h"
#include "deck/registry.h"
#include "geometry/fill.h"
#include "geometry/shapes.h"

namespace sphgeo {
namespace {

/// A face of the tank: its name in the deck, axis and side.
struct Face {
  const char* name;
  int axis;
  bool high;
};
constexpr std::array<Face, 6> faces{{{"left", 0, false},
                                     {"right", 0, true},
                                     {"front", 1, false},
                                     {"back", 1, true},
                                     {"bottom", 2, false},
                                     {"top", 2, true}}};

std::string rounded(double n) { return fmt::format("{:.3g}", n); }

/// A container: walls around a box, some faces open.
struct Tank final : WallBoundary {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  std::vector<std::string> open;

  static Schema<Tank> schema() {
    Schema<Tank> s("tank", "walls around the inside of a box");
    s.required("min", &Tank::min, unit::length, "lower corner of the inside");
    s.required("max", &Tank::max, unit::length, "upper corner of the inside");
    s.optional("open", &Tank::open, unit::none,
               "faces without a wall (front and back are normal to y)")
        .choices({"left", "right", "front", "back", "bottom", "top"});
    declare_wall_keys(s);
    s.check([](Tank& t, CheckContext& c) {
      for (int k = 0; k < 3; ++k)
        if (!(k == 1 && c.dimension() == 2) && !(t.max[k] > t.min[k]))
          return c.error("max", std::string("the tank has no extent along ") + "xyz"[k],
                         "max must exceed min in every direction");
      // Its walls are some layers thick: six faces, in spacings, bound their particles from below.
      if (!(c.resolution() > 0)) return;
      const Vec3 n = ((t.max - t.min) / c.resolution()).cwiseMax(1.0);
      const double faces_of =
          c.dimension() == 2 ? n.x() + n.z() : n.x() * n.y() + n.y() * n.z() + n.z() * n.x();
      if (!(faces_of <= largest_fill))
        c.error("",
                "the walls of the tank would take about " + rounded(faces_of) +
                    " particles in each layer",
                "is the resolution or a length in the wrong unit?");
    });
    return s;
  }

  bool is_open(int axis, bool high) const {
    return std::any_of(faces.begin(), faces.end(), [&](const Face& f) {
      return f.axis == axis && f.high == high &&
             std::find(open.begin(), open.end(), f.name) != open.end();
    });
  }

  /// Coordinates of the particles along one axis: the inside evenly divided, so that walls stand
  /// exactly on the faces whatever the size of the tank, then the layers of the walls.
  struct Axis {
    std::vector<double> at;
    std::vector<bool> outside;
  };
  Axis axis(int k, const Placement& p) const {
    if (k == 1 && p.dimension == 2) return {{0.0}, {false}};
    Axis a;
    const int layers = static_cast<int>(std::ceil(p.thickness / p.spacing - 1e-9));
    const double length = max[k] - min[k];
    const auto inside = static_cast<Index>(std::max(1.0, std::round(length / p.spacing)));
    const auto add = [&](double at, bool outside) {
      a.at.push_back(at);
      a.outside.push_back(outside);
    };
    if (!is_open(k, false))
      for (int i = layers - 1; i >= 0; --i) add(min[k] - (i + 0.5) * p.spacing, true);
    for (Index i = 0; i < inside; ++i)
      add(min[k] + (static_cast<double>(i) + 0.5) * length / static_cast<double>(inside), false);
    if (!is_open(k, true))
      for (int i = 0; i < layers; ++i) add(max[k] + (i + 0.5) * p.spacing, true);
    return a;
  }

  /// Towards the inside; on the rim of an open face towards that face, so that water that comes to
  /// lie on the rim is not attracted through the wall.
  Vec3 normal_at(const Vec3& x, const Vec3& inner, int dimension) const {
    double nearest = (inner - x).norm();
    Vec3 normal = (inner - x) / nearest;
    for (const Face& f : faces) {
      if (!is_open(f.axis, f.high) || (dimension == 2 && f.axis == 1)) continue;
      const double depth = f.high ? max[f.axis] - x[f.axis] : x[f.axis] - min[f.axis];
      if (depth >= nearest) continue;
      nearest = depth;
      normal = Vec3::Unit(f.axis) * (f.high ? 1.0 : -1.0);
    }
    return normal;
  }

  std::vector<WallPoint> points(const Placement& p) const override {
    const Axis ax = axis(0, p), ay = axis(1, p), az = axis(2, p);
    std::vector<std::vector<WallPoint>> layers(az.at.size());
    parallel_blocks(static_cast<Index>(layers.size()), 1, [&](Index layer, Index, Index) {
      const auto k = static_cast<std::size_t>(layer);
      for (std::size_t j = 0; j < ay.at.size(); ++j)
        for (std::size_t i = 0; i < ax.at.size(); ++i) {
          if (!ax.outside[i] && !ay.outside[j] && !az.outside[k]) {
            // Skip to the opposite wall: the inside of a large tank has far more positions than its
            // walls.
            while (i + 1 < ax.at.size() && !ax.outside[i + 1]) ++i;
            continue;
          }
          const Vec3 x(ax.at[i], ay.at[j], az.at[k]);
          Vec3 inner = x.cwiseMax(min).cwiseMin(max);
          if (p.dimension == 2) inner.y() = 0;
          layers[k].push_back({x, normal_at(x, inner, p.dimension)});
        }
    });
    std::vector<WallPoint> wall;
    for (const auto& layer : layers) wall.insert(wall.end(), layer.begin(), layer.end());
    return wall;
  }

  /// Particles along one axis, in all and inside.
  std::pair<double, double> axis_count(int k, const Placement& p) const {
    if (k == 1 && p.dimension == 2) return {1, 1};
    const double inside = std::max(1.0, std::round((max[k] - min[k]) / p.spacing));
    const double layers = std::ceil(p.thickness / p.spacing - 1e-9);
    return {inside + (is_open(k, false) ? 0 : layers) + (is_open(k, true) ? 0 : layers), inside};
  }

  double expected_points(const Placement& p) const override {
    double all = 1, within = 1;
    for (int k = 0; k < 3; ++k) {
      const auto [n, inside] = axis_count(k, p);
      all *= n;
      within *= inside;
    }
    return all - within;
  }

  std::vector<OpenFace> open_faces(const Placement& p) const override {
    std::vector<OpenFace> gaps;
    for (const Face& f : faces) {
      if (!is_open(f.axis, f.high) || (p.dimension == 2 && f.axis == 1)) continue;
      OpenFace gap{f.name, f.axis, f.high, {}};
      std::array<std::vector<double>, 3> at;
      for (int k = 0; k < 3; ++k) {
        const Axis a = axis(k, p);
        if (k == f.axis)
          at[static_cast<std::size_t>(k)] = {f.high ? max[k] + 0.5 * p.spacing
                                                    : min[k] - 0.5 * p.spacing};
        else
          for (std::size_t i = 0; i < a.at.size(); ++i)
            if (!a.outside[i]) at[static_cast<std::size_t>(k)].push_back(a.at[i]);
      }
      for (const double z : at[2])
        for (const double y : at[1])
          for (const double x : at[0]) gap.points.emplace_back(x, y, z);
      gaps.push_back(std::move(gap));
    }
    return gaps;
  }

  std::shared_ptr<const Shape> solid(const Placement& p) const override {
    auto outer = std::make_shared<Box>(), inner = std::make_shared<Box>();
    outer->flat = inner->flat = p.dimension == 2;
    outer->min = inner->min = min;
    outer->max = inner->max = max;
    for (const Face& f : faces) {
      const bool gap = is_open(f.axis, f.high);
      // An open face has no wall: the inner box extends beyond it and the outer one does not.
      Vec3& out = f.high ? outer->max : outer->min;
      Vec3& in = f.high ? inner->max : inner->min;
      const double by = f.high ? p.thickness : -p.thickness;
      (gap ? in : out)[f.axis] += by;
    }
    auto solid = std::make_shared<Difference>();
    solid->flat = p.dimension == 2;
    solid->of = {outer, inner};
    return solid;
  }
};

const Register<BoundarySpec, Tank> registered_tank{"tank"};

}  // namespace
}  // namespace sphgeo
