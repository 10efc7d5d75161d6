#include <algorithm>
#include <cmath>
#include <limits>

#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"
#include "probes/solid_scene.h"

namespace sphgeo {
namespace {

/// Penetration depth of a solid in other solids and walls. A surface lies half a spacing outside of
/// the outermost particles, and its normal points away from the surrounding particles; this holds
/// also for bodies that rotate and bend.
struct PenetrationProbe final : Probe {
  std::string body;

  static Schema<PenetrationProbe> schema() {
    Schema<PenetrationProbe> s(
        "penetration",
        "penetration depth of the surface of a solid in other solids or walls; surfaces lie half a "
        "spacing outside of the outermost particles");
    s.optional("body", &PenetrationProbe::body, unit::none,
               "name of the body; empty: the largest of all solids");
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"depth", "m", "largest depth; 0 without contact"},
            {"spacings", "1", "the same over the mean spacing of the two particles"}};
  }
  void inspect(const Model& model, CheckContext& c) const override {
    if (!body.empty()) inspect_body(model, body, "body", c);
  }
  std::vector<FieldRequest> needs(const Model& model) const override {
    return {{set_of_body(model, body), &fields::mass}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    out[0] = out[1] = 0.0;
    if (!scene.has_set("interface")) return;
    const std::int32_t wanted = body.empty() ? -1 : body_index(scene.model(), body);
    const auto part = scene.tag("interface", fields::part);
    const auto x = scene.vector("interface", fields::position);
    const auto volume = scene.scalar("interface", fields::reference_volume);
    const auto spacing = [&](Index i) { return std::pow(volume(i), 1.0 / scene.dimension()); };
    const bool walls = scene.has_set("walls");
    for (Index i = 0; i < scene.size("interface"); ++i) {
      const std::int32_t own = part(i);
      if (wanted >= 0 && own != wanted) continue;
      const Patch mine = patch(scene, "interface", x(i), [&](Index j) { return part(j) == own; });
      const auto against = [&](const Patch& theirs, double theirs_spacing) {
        if (theirs.nearest < 0) return;
        const double mean = 0.5 * (spacing(i) + theirs_spacing);
        const double depth = mean - gap(mine, theirs, x(i), mean, scene.dimension());
        out[0] = std::max(*out[0], depth);
        out[1] = std::max(*out[1], depth / mean);
      };
      const Patch others = patch(scene, "interface", x(i), [&](Index j) { return part(j) != own; });
      if (others.nearest >= 0) against(others, spacing(others.nearest));
      if (walls)
        against(patch(scene, "walls", x(i), [](Index) { return true; }), scene.spacing("walls"));
    }
  }

 private:
  /// Particles around a point, the nearest of them, and the direction away from the others around
  /// that one.
  struct Patch {
    std::vector<Vec3> at;
    Index nearest = -1;
    Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  };

  template <class Select>
  static Patch patch(const SceneView& scene, const std::string& set, const Vec3& point,
                     Select&& select) {
    const auto x = scene.vector(set, fields::position);
    Patch p;
    double least = std::numeric_limits<double>::infinity();
    scene.near(set, point, [&](Index j, double) {
      if (!select(j)) return;
      p.at.push_back(x(j));
      if (const double r = (x(j) - point).norm(); r < least) {
        least = r;
        p.nearest = j;
      }
    });
    if (p.nearest < 0) return p;
    p.position = x(p.nearest);
    scene.near(set, p.position, [&](Index k, double w) {
      if (select(k)) p.normal -= w * (x(k) - p.position);
    });
    p.normal.normalize();
    return p;
  }

  /// Distance between the outermost particles of two patches, negative when they overlap: as for
  /// convex bodies the largest of several directions: the normals of both, and the one between
  /// these. Only particles near one line along a direction are considered.
  static double gap(const Patch& a, const Patch& b, const Vec3& point, double spacing,
                    int dimension) {
    const Vec3 middle = 0.5 * (point + b.position);
    const double aside = 0.55 * spacing * std::sqrt(dimension - 1.0);
    double best = -std::numeric_limits<double>::infinity();
    for (const Vec3& n : {b.normal, Vec3(-a.normal), Vec3((b.normal - a.normal).normalized())}) {
      if (n.isZero(0)) continue;
      const auto along = [&](const Vec3& p) { return (p - middle).dot(n); };
      const auto beside = [&](const Vec3& p) {
        return (p - middle - along(p) * n).norm() <= aside;
      };
      double low = along(point), high = along(b.position);
      for (const Vec3& p : a.at)
        if (beside(p)) low = std::min(low, along(p));
      for (const Vec3& p : b.at)
        if (beside(p)) high = std::max(high, along(p));
      best = std::max(best, low - high);
    }
    return best;
  }
};

const Register<ProbeSpec, PenetrationProbe> registered_penetration{"penetration"};

}  // namespace
}  // namespace sphgeo
