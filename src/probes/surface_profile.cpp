#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/surface.h"

namespace sphgeo {
namespace {

/// Heights of a surface along a line.
struct SurfaceProfileProbe final : Probe {
  std::string set = "soil";
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  int points = 21;

  static Schema<SurfaceProfileProbe> schema() {
    Schema<SurfaceProfileProbe> s("surface_profile",
                                  "heights of the topmost surface of a set along a line");
    s.optional("set", &SurfaceProfileProbe::set, unit::none, "the particle set")
        .choices({"water", "soil"});
    s.required("from", &SurfaceProfileProbe::from, unit::length,
               "start of the line; its z is ignored");
    s.required("to", &SurfaceProfileProbe::to, unit::length, "end of the line; its z is ignored");
    s.optional("points", &SurfaceProfileProbe::points, unit::none,
               "number of points, both ends included")
        .at_least(2)
        .at_most(1000);
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    std::vector<Column> columns;
    for (int k = 0; k < points; ++k) {
      const Vec3 at = point(k);
      columns.push_back(
          {fmt::format("height_{}", k), "m",
           fmt::format("z of the surface at x = {:.6g} m, y = {:.6g} m; empty where there is none",
                       at.x(), at.y()),
           std::hypot(at.x() - from.x(), at.y() - from.y())});
    }
    columns.push_back({"slope_angle", "deg",
                       "slope of the least-squares line through the heights, positive when rising "
                       "from start to end"});
    return columns;
  }
  std::vector<FieldRequest> needs(const Model&) const override { return {{set, &fields::volume}}; }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    std::vector<Vec3> positions;
    for (int k = 0; k < points; ++k) positions.push_back(point(k));
    const auto heights = surface_heights(scene, set, positions);
    std::copy(heights.begin(), heights.end(), out.begin());
    double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
    for (int k = 0; k < points; ++k) {
      const auto& z = heights[static_cast<std::size_t>(k)];
      if (!z) continue;
      const Vec3 offset = point(k) - from;
      const double x = std::hypot(offset.x(), offset.y());
      n += 1;
      sx += x;
      sz += *z;
      sxx += x * x;
      sxz += x * *z;
    }
    const double spread = n * sxx - sx * sx;
    if (n >= 2 && spread > 0)
      out.back() = std::atan((n * sxz - sx * sz) / spread) * 180 / std::numbers::pi;
  }

 private:
  Vec3 point(int k) const { return from + (to - from) * k / (points - 1); }
};

const Register<ProbeSpec, SurfaceProfileProbe> registered_surface_profile{"surface_profile"};

}  // namespace
}  // namespace sphgeo
