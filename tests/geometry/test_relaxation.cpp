// Level-set-guided relaxation: body-fitted, even, the same for any number of threads.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "geometry/fill.h"
#include "geometry/level_set_mesh.h"
#include "geometry/relaxation.h"
#include "read_shape.h"
#include "sph/kernel.h"

using namespace sphgeo;
using geometry_test::shape_of;

namespace {

/// One thread while it lives: these runs are too small to share.
struct OneThread {
  OneThread() { set_threads(1); }
  ~OneThread() { set_threads(before); }
  int before = threads();
};

/// Standard deviation of the number density over its mean, of all particles.
double spread_of(const RelaxedPositions& r) {
  double sum = 0, square = 0;
  for (const double d : r.number_density) sum += d;
  const double n = static_cast<double>(r.at.size()), mean = sum / n;
  for (const double d : r.number_density) square += (d - mean) * (d - mean);
  return std::sqrt(square / n) / mean;
}

/// Rms of (depth - dp/2) / dp over the outermost particles: those nearer to the surface than the
/// gap between the first two layers.
double surface_offset(const RelaxedPositions& r, const Shape& shape, double dp) {
  double square = 0, count = 0;
  for (const Vec3& p : r.at) {
    const double d = shape.signed_distance(p);
    if (d < -0.9 * dp) continue;
    square += (d / dp + 0.5) * (d / dp + 0.5);
    count += 1;
  }
  return std::sqrt(square / count);
}

/// The outermost layer lies dp/2 below the surface, density is even, nothing is outside.
void check_fitted(const std::string& yaml, double dp, int dim, double measure) {
  CAPTURE(yaml);
  CAPTURE(dim);
  const OneThread one;
  const ShapePtr s = shape_of(yaml, dim);
  const RelaxedPositions r = relax_fill(*s, dp, dim);
  REQUIRE(r.at.size() > 300);
  CHECK(spread_of(r) < 0.03);
  RelaxedPositions start = r;
  start.number_density = r.start_density;
  CHECK(spread_of(r) < 0.5 * spread_of(start));
  const auto [low, high] = std::minmax_element(r.number_density.begin(), r.number_density.end());
  CHECK(*low > 0.9);
  CHECK(*high < 1.1);
  CHECK(surface_offset(r, *s, dp) < 0.1);
  double least_gap = 1e9;
  int outermost = 0;
  for (std::size_t i = 0; i < r.at.size(); ++i) {
    const double d = s->signed_distance(r.at[i]);
    CHECK(d < -0.49 * dp);
    outermost += d > -0.6 * dp;
    if (i < 200)
      for (std::size_t j = 0; j < i; ++j)
        least_gap = std::min(least_gap, (r.at[i] - r.at[j]).norm());
  }
  CHECK(least_gap > 0.7 * dp);
  CHECK(static_cast<double>(r.at.size()) * r.volume == doctest::Approx(measure).epsilon(0.01));
  // A closed layer holds about surface / dp^(dim-1) particles.
  CHECK(outermost >
        0.75 * std::pow(measure / std::pow(dp, dim), (dim - 1.0) / dim) * (dim == 2 ? 3.0 : 4.2));
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE_TEMPLATE("relaxation: what the kernel misses beyond a plane wall", D,
                     std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
    const OneThread one;
    constexpr int dim = D::value;
    const double h = 0.13;
    Box b;
    b.max = {2, 2, 2};
    b.flat = dim == 2;
    const MissingSupport<dim> missing(b, b.box(), h, 2 * h);
    CHECK(missing.surface().volume() == doctest::Approx(dim == 2 ? 4.0 : 8.0).epsilon(0.005));
    const auto at = [](double x) { return to_scene<dim>(Vec3(x, dim == 2 ? 0.0 : 1.0, 1)); };
    CHECK(missing(at(1), h).sum == 0.0);
    for (const double width : {h, 1.1 * h, 2 * h}) {
      // On the wall itself half of the kernel is missing.
      const auto wall = missing(at(2), width);
      CHECK(wall.sum == doctest::Approx(0.5).epsilon(0.02));
      CHECK(std::abs(wall.gradient[dim - 1]) < 1e-4);
      // Half a smoothing length inside, against a sum over many points.
      const Kernel<dim> kernel(width);
      const double apart = 0.5 * width, step = width / 12;
      double sum = 0, slope = 0;
      for (double x = apart + 0.5 * step; x < 2 * width; x += step)
        for (double z = 0.5 * step - 2 * width; z < 2 * width; z += step)
          for (double y = 0.5 * step - 2 * width; y < 2 * width; y += step) {
            const double r2 = x * x + z * z + (dim == 3 ? y * y : 0), part = std::pow(step, dim);
            sum += kernel.w(r2) * part;
            slope -= kernel.dw_over_r(r2) * part * x;
            if (dim == 2) break;
          }
      const auto inside = missing(at(2 - apart), width);
      CHECK(inside.sum == doctest::Approx(sum).epsilon(0.03));
      CHECK(inside.gradient[0] == doctest::Approx(slope).epsilon(0.03));
    }
  }

  TEST_CASE("relaxation: distances of the mesh, and where its surface is plane") {
    const OneThread one;
    const double dp = 0.1, band = 3 * dp;
    for (const char* yaml :
         {"{type: sphere, center: [0, 0, 0], radius: 0.5}",
          "{type: box, min: [-0.6, -0.5, -0.4], max: [0.6, 0.5, 0.4]}",
          "{type: difference, of: [{type: box, min: [-1, -1, -1], max: [1, 1, 1]},"
          " {type: sphere, center: [0, 0, 0], radius: 0.12}]}",
          // Two parts that touch: their seam is no surface.
          "{type: union, of: [{type: box, min: [-0.6, -0.5, -0.4], max: [0, 0.5, 0.4]},"
          " {type: box, min: [0, -0.5, -0.4], max: [0.6, 0.5, 0.4]}]}"}) {
      CAPTURE(std::string(yaml));
      const ShapePtr s = shape_of(yaml, 3);
      const LevelSetMesh<3> mesh(*s, s->box(), 1.3 * dp, band);
      const bool seam = s->type == "union";
      int asked = 0, plane = 0;
      const Aabb box = s->box();
      for (int k = 0; k < 30 * 30 * 30; ++k) {
        const Vec3 p =
            box.lo + (box.hi - box.lo)
                         .cwiseProduct(Vec3(k % 30 + 0.5, k / 30 % 30 + 0.5, k / 900 + 0.5) / 30);
        const double d = s->signed_distance(p);
        if (d >= 0) continue;
        const auto found = mesh.distance(p);
        CHECK(found.value >= -band - 1e-6);
        if (seam && d < -0.5 * dp) CHECK(found.value < -0.3 * dp);  // deep, but not how deep
        else CHECK(std::abs(found.value - std::max(d, -band)) < 0.2 * dp);
        if (d < -0.75 * dp) continue;
        ++asked;
        if (std::abs(found.gradient.norm() - 1) > 0.01) continue;
        ++plane;
        CHECK(std::abs(found.value - d) < 0.02 * dp);
      }
      CHECK(plane > 0.4 * asked);  // a bent surface of so few nodes is plane in half of its cells
    }
  }

  TEST_CASE("relaxation: discs, ellipses and balls are body-fitted and even") {
    check_fitted("{type: sphere, center: [0, 0, 0], radius: 1}", 0.06, 2, 3.14159);
    check_fitted("{type: ellipsoid, center: [0.3, 0, 0], semi_axes: [1, 0, 0.5]}", 0.05, 2, 1.5708);
    check_fitted("{type: sphere, center: [0, 0, 0], radius: 1}", 0.16, 3, 4.18879);
  }

  TEST_CASE("relaxation: a turned box is even, a lattice box is at rest") {
    const OneThread one;
    const ShapePtr b = shape_of("{type: box, min: [0, 0, 0], max: [1, 0, 1]}", 2);
    const RelaxedPositions rest = relax_fill(*b, 0.05, 2);
    CHECK(rest.history.size() < 201);  // converged
    CHECK(spread_of(rest) < 0.01);
    CHECK(surface_offset(rest, *b, 0.05) < 0.01);
    const ShapePtr t = shape_of(
        "{type: transform, of: {type: box, min: [0, 0, 0], max: [1, 0, 1]}, rotate: 27 deg}", 2);
    const RelaxedPositions turned = relax_fill(*t, 0.05, 2);
    CHECK(spread_of(turned) < 0.03);
    CHECK(surface_offset(turned, *t, 0.05) < 0.1);
  }

  TEST_CASE("relaxation: thin and pointed bodies keep their particles, inside and apart") {
    constexpr double dp = 0.05;
    const OneThread one;
    const auto check_kept = [&](const std::string& yaml, int dim, double outside, double apart) {
      CAPTURE(yaml);
      CAPTURE(dim);
      const ShapePtr s = shape_of(yaml, dim);
      const RelaxedPositions r = relax_fill(*s, dp, dim);
      REQUIRE_FALSE(r.at.empty());
      double farthest = -1, nearest = 1;
      for (std::size_t i = 0; i < r.at.size(); ++i) {
        REQUIRE(r.at[i].allFinite());
        farthest = std::max(farthest, s->signed_distance(r.at[i]));
        for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (r.at[i] - r.at[j]).norm());
      }
      CHECK(farthest <= outside * dp);
      CHECK(nearest >= apart * dp);
    };
    // Slivers, whose ridge lies less than half a spacing deep.
    for (const char* points : {"[[0, 0, 0], [1, 0, 0.03], [0.5, 0, 0.05], [0.02, 0, 1]]",
                               "[[0.408, 0, 0.352], [0.455, 0, 0.803], [0.453, 0, 0.959]]"})
      check_kept(std::string("{type: polygon, y_min: 0, y_max: 0.3, points: ") + points + "}", 2,
                 1e-6, 0.4);
    for (const double spacings : {0.5, 1.0, 1.5, 2.0})
      for (const double turned : {0.3, 0.785}) {
        const std::string plate = fmt::format(
            "{{type: transform, rotate: {}, of: {{type: box, min: [0.013, 0, 0.021], max: [0.5, "
            "0.3, {}]}}}}",
            turned, 0.021 + spacings * dp);
        for (const int dim : {2, 3}) check_kept(plate, dim, 1e-6, 0.4);
      }
  }

  TEST_CASE("relaxation: the same bits for one and three threads") {
    const ShapePtr s = shape_of("{type: sphere, center: [0, 0, 0], radius: 1}", 2);
    RelaxationOptions o;
    o.steps = 5;
    const Seeds seeds{fill_lattice(*s, 0.04, 2), {}};
    const int before = threads();
    set_threads(1);
    const RelaxedPositions one = relax(*s, {}, seeds, 0.04, 2, o);
    for (const int n : {2, 3}) {
      set_threads(n);
      const RelaxedPositions more = relax(*s, {}, seeds, 0.04, 2, o);
      CHECK(one.at == more.at);
      CHECK(one.number_density == more.number_density);
    }
    set_threads(before);
    CHECK(one.history.size() == 6);
  }

  // The table of share/doc/relaxation.md: sphgeo_tests --no-skip -tc="relaxation: cost*"
  TEST_CASE("relaxation: cost and offset of fillings" * doctest::skip()) {
    struct Filling {
      const char* name;
      const char* yaml;
      double dp;
      int dim;
    };
    const char* const box = "{type: box, min: [0, 0, 0], max: [1, 1, 1]}";
    const char* const turned =
        "{type: transform, of: {type: box, min: [0, 0, 0], max: [1, 1, 1]}, rotate: 27 deg}";
    const char* const ball = "{type: sphere, center: [0, 0, 0], radius: 1}";
    const int before = threads();
    for (const Filling& f :
         {Filling{"square", box, 1 / 100.5, 2},
          Filling{"square, turned by 27 deg", turned, 0.01, 2}, Filling{"disc", ball, 1 / 40.0, 2},
          Filling{"cube", box, 1 / 30.5, 3}, Filling{"cube, turned by 27 deg", turned, 1 / 30.0, 3},
          Filling{"ball", ball, 1 / 16.0, 3}}) {
      const ShapePtr s = shape_of(f.yaml, f.dim);
      std::string row = f.name;
      for (const int n : {1, 2}) {
        set_threads(n);
        RelaxedPositions r;
        double least = 1e300;  // of three runs: other programs disturb
        for (int repeat = 0; repeat < 3; ++repeat) {
          const auto start = std::chrono::steady_clock::now();
          r = relax_fill(*s, f.dp, f.dim);
          const std::chrono::duration<double, std::micro> took =
              std::chrono::steady_clock::now() - start;
          least = std::min(least, took.count());
        }
        const auto steps = static_cast<double>(r.history.size() - 1);
        if (n == 1)
          row += fmt::format(" | {} | {} | {:.3f} | {:.2f} %", r.at.size(), steps,
                             surface_offset(r, *s, f.dp), 100 * spread_of(r));
        row += fmt::format(" | {:.3f}", least / static_cast<double>(r.at.size()) / steps);
      }
      std::printf("| %s |\n", row.c_str());
    }
    set_threads(before);
  }
}
