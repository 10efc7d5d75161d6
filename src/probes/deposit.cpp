#include <algorithm>
#include <cmath>
#include <numbers>

#include "deck/registry.h"
#include "deck/schema.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

/// Run-out, height and slope of a heap.
struct DepositProbe final : Probe {
  std::string set = "soil";
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();
  bool radial = false;

  static Schema<DepositProbe> schema() {
    Schema<DepositProbe> s("deposit",
                           "run-out, height and slope of a heap that is connected to its origin");
    s.optional("set", &DepositProbe::set, unit::none, "the particle set")
        .choices({"water", "soil"});
    s.optional("origin", &DepositProbe::origin, unit::length,
               "origin of distances; its z is the base of heights");
    s.optional("direction", &DepositProbe::direction, unit::none,
               "horizontal direction of the distances")
        .keep_y();
    s.optional(
        "radial", &DepositProbe::radial, unit::none,
        "whether distances count from the vertical axis through the origin, in 2D to both sides");
    s.check([](DepositProbe& p, CheckContext& c) {
      p.direction.z() = 0;
      if (!(p.direction.norm() > 0))
        c.error("direction", "the direction has no horizontal length",
                "give a vector such as [1, 0, 0]");
      else p.direction.normalize();
    });
    return s;
  }
  std::vector<Column> columns(const Model&) const override {
    return {{"runout", "m",
             "run-out: distance from the origin up to which the heap is connected and thicker than "
             "one layer of particles"},
            {"crest", "m", "largest height of the connected heap over the base"},
            {"height", "m", "height over the origin"},
            {"slope_angle", "deg",
             "slope between 20 and 80 % of the crest, a line fitted to the heights; empty for a "
             "flat heap"}};
  }
  std::vector<FieldRequest> needs(const Model&) const override {
    return {{set, &fields::position}};
  }

  void sample(const SceneView& scene, std::span<std::optional<double>> out) const override {
    if (!scene.has_set(set) || scene.size(set) == 0) return;
    const auto x = scene.vector(set, fields::position);
    const double dp = scene.spacing(set), width = bin_width * dp;
    // The highest and the farthest particle in rings (strips) of 1.5 spacings. Isolated grains
    // ahead of the front are not part of the heap: around a particle of the heap its set fills at
    // least two thirds of the kernel. One layer of particles fills 0.58 of it, two layers 0.79.
    const double volume = std::pow(dp, scene.dimension());
    struct Bin {
      double height = -INFINITY, reach = -INFINITY;
    };
    std::vector<Bin> bins;
    for (Index i = 0; i < scene.size(set); ++i) {
      const Vec3 d = x(i) - origin;
      const double at = radial ? std::hypot(d.x(), d.y()) : d.dot(direction);
      if (at < 0) continue;
      const auto k = static_cast<std::size_t>(at / width);
      if (k > 1000000) continue;
      double filled = 0;
      scene.near(set, x(i), [&](Index, double w) { filled += volume * w; });
      if (filled < 2.0 / 3.0) continue;
      if (k >= bins.size()) bins.resize(k + 1);
      bins[k].height = std::max(bins[k].height, d.z() + 0.5 * dp);
      bins[k].reach = std::max(bins[k].reach, at + 0.5 * dp);
    }
    // Walls at planes of symmetry truncate the kernel: the heap begins with the first ring or the
    // second.
    const std::size_t begin = bins.size() > 1 && !std::isfinite(bins[0].height) ? 1 : 0;
    std::size_t connected = begin;
    while (connected < bins.size() && std::isfinite(bins[connected].height)) ++connected;
    if (connected == begin) return;
    std::size_t top = begin;
    for (std::size_t k = begin; k < connected; ++k)
      if (bins[k].height > bins[top].height) top = k;
    out[0] = bins[connected - 1].reach;
    out[1] = bins[top].height;
    out[2] = bins[begin].height;
    double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
    for (std::size_t k = top; k < connected; ++k) {
      const double z = bins[k].height, at = (static_cast<double>(k) + 0.5) * width;
      if (z < 0.2 * bins[top].height || z > 0.8 * bins[top].height) continue;
      ++n;
      sx += at;
      sz += z;
      sxx += at * at;
      sxz += at * z;
    }
    const double spread = n * sxx - sx * sx;
    if (n >= 3 && spread > 0)
      out[3] = -std::atan((n * sxz - sx * sz) / spread) * 180 / std::numbers::pi;
  }

 private:
  // In a loose front particles of one layer are farther apart than a spacing.
  static constexpr double bin_width = 1.5;
};

const Register<ProbeSpec, DepositProbe> registered_deposit{"deposit"};

}  // namespace
}  // namespace sphgeo
