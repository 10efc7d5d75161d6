// Probes against what soil and solids of known content must give, in 2D (per metre of depth) and
// 3D. share/doc/probes.md names these tests.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <numbers>

#include "core/parallel.h"
#include "scene/cross_check.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// A block of soil, 1 m by 0.8 m, in 3D 0.5 m deep; all fields are set by the tests.
std::string bed(int dimension, const std::string& probes, const std::string& shape = "") {
  return fmt::format(
      R"(
dimension: {}
resolution: 0.05
end_time: 1
materials:
  - {{name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 10 MPa,
      poisson_ratio: 0.25, cohesion: 100 kPa, friction_angle: 30 deg}}
bodies:
  - {{name: bed, material: sand, shape: {}}}
probes:
{})",
      dimension, shape.empty() ? "{type: box, min: [0, 0, 0], max: [1, 0.5, 0.8]}" : shape, probes);
}

template <int Dim>
void observe(Rig<Dim>& rig) {
  rig.plan->run(Stage::observe);
}

template <int Dim>
void check_soil_sums() {
  Rig<Dim> rig(bed(Dim,
                   "  - {name: a, type: amount, set: soil}\n"
                   "  - {name: f, type: flux, set: soil, point: [0.5, 0, 0], normal: [1, 0, 0]}\n"
                   "  - {name: m, type: moments, set: soil}\n"
                   "  - {name: e, type: energy, set: soil}\n"
                   "  - {name: front, type: front, set: soil, direction: [0, 0, 1]}\n"));
  rig.plan_it();
  constexpr double s = 2e4;
  for (Index i = 0; i < rig.soil().size(); ++i) {
    rig.soil().vector(fields::velocity)[i] = to_scene<Dim>(Vec3(1.5, 0, 2));
    rig.soil().tensor(fields::stress)[i] << 0, 0, -s, 0, 0, 0;
    rig.soil().scalar(fields::plastic_work)[i] = 0.25;
  }
  observe(rig);
  const double depth = Dim == 2 ? 1 : 0.5, volume = 0.8 * depth, mass = 0.6 * 2600 * volume;
  const auto amount = rig.sample(0);
  CHECK(*amount[0] == doctest::Approx(mass));
  CHECK(*amount[1] == doctest::Approx(volume));
  CHECK(*amount[2] == static_cast<double>(rig.soil().size()));
  CHECK(*amount[3] == doctest::Approx(0.6 * volume));
  const auto flux = rig.sample(1);
  CHECK(*flux[0] == doctest::Approx(1.5 * 0.8 * depth));
  CHECK(*flux[1] == doctest::Approx(1.5 * 0.8 * depth * 0.6 * 2600));
  // A box of length L has the second moment L^2 / 12, an ellipse of semi-axis a has a^2 / 4.
  const auto moments = rig.sample(2);
  const double factor = Dim + 2;
  CHECK(*moments[0] == doctest::Approx(std::sqrt(factor / 12)));
  CHECK(*moments[Dim - 1] == doctest::Approx(0.8 * std::sqrt(factor / 12)));
  CHECK(*moments[Dim] == doctest::Approx(0.5));
  CHECK(*moments[2 * Dim - 1] == doctest::Approx(0.4));
  const double ball = Dim == 2 ? std::numbers::pi : 4 * std::numbers::pi / 3;
  CHECK(*moments[2 * Dim] == doctest::Approx(ball * std::pow(factor / 12, Dim / 2.0) * volume));
  const auto energy = rig.sample(3);
  CHECK(*energy[0] == doctest::Approx(0.5 * mass * 6.25));
  CHECK(*energy[1] == doctest::Approx(mass * 9.81 * 0.4));
  CHECK(*energy[2] == doctest::Approx(volume * s * s / (2 * 10e6)));  // one axis: s^2 / 2E
  CHECK(*energy[3] == doctest::Approx(*energy[0] + *energy[1] + *energy[2]));
  CHECK(*energy[4] == doctest::Approx(0.25 * static_cast<double>(rig.soil().size())));
  CHECK(*rig.sample(4)[0] == doctest::Approx(0.8));
  // Per metre of depth in 2D.
  const auto unit = [&](std::size_t k, std::size_t column) {
    return dynamic_cast<const Probe&>(*rig.model.probes[k]).columns(rig.model)[column].unit;
  };
  CHECK(unit(0, 0) == (Dim == 2 ? "kg/m" : "kg"));
  CHECK(unit(0, 1) == (Dim == 2 ? "m2" : "m3"));
  CHECK(unit(1, 0) == (Dim == 2 ? "m2/s" : "m3/s"));
  CHECK(unit(3, 0) == (Dim == 2 ? "J/m" : "J"));
}

// Linear stress on particles that do not lie on a lattice, inside and on faces.
template <int Dim>
void check_soil_points() {
  Rig<Dim> rig(bed(Dim,
                   "  - {name: inside, type: stress, at: [0.43, 0.2, 0.37]}\n"
                   "  - {name: at_floor, type: stress, at: [0.52, 0.25, 0]}\n"
                   "  - {name: outside, type: stress, at: [1.3, 0.25, 0.4]}\n"
                   "  - {name: v, type: velocity, set: soil, at: [0, 0.25, 0.33]}\n"));
  rig.jitter_set("soil", 0.2);
  rig.plan_it();
  const auto stress = [](const Vec3& x) {
    Sym3 s;
    s << -100 - 30 * x.z(), -80 + 10 * x.x(), -300 + 500 * x.z(), 20, Dim == 2 ? 0 : 5, 40 * x.x();
    return s;
  };
  for (Index i = 0; i < rig.soil().size(); ++i) {
    const Vec3 x = to_space<Dim>(rig.soil().vector(fields::position)[i]);
    rig.soil().tensor(fields::stress)[i] = stress(x);
    rig.soil().scalar(fields::plastic_strain)[i] = 0.1 * x.z();
    rig.soil().scalar(fields::volume_fraction)[i] = 0.6 - 0.1 * x.z();
    rig.soil().vector(fields::velocity)[i] = to_scene<Dim>(Vec3(1 + 2 * x.z(), 0, 3 - x.x()));
  }
  observe(rig);
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 at = dynamic_cast<const Probe&>(*rig.model.probes[k]).positions()[0];
    const Sym3 s = stress(at);
    const auto out = rig.sample(k);
    REQUIRE(out[0].has_value());
    for (std::size_t c = 0; c < 6; ++c)
      CHECK(*out[c] == doctest::Approx(s[static_cast<Index>(c)]).epsilon(1e-9));
    const double p = -(s[0] + s[1] + s[2]) / 3;
    const double j2 =
        ((s[0] + p) * (s[0] + p) + (s[1] + p) * (s[1] + p) + (s[2] + p) * (s[2] + p)) / 2 +
        s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    CHECK(*out[6] == doctest::Approx(p).epsilon(1e-9));
    CHECK(*out[7] == doctest::Approx(std::sqrt(3 * j2)).epsilon(1e-9));
    CHECK(*out[8] == doctest::Approx(0.1 * at.z()).epsilon(1e-9).scale(0.1));
    CHECK(*out[9] == doctest::Approx(0.6 - 0.1 * at.z()).epsilon(1e-9));
    CHECK(*out[10] == doctest::Approx(k == 0 ? 1 : 0.5).epsilon(0.2));
  }
  CHECK_FALSE(rig.sample(2)[0].has_value());
  CHECK(*rig.sample(2)[10] == 0.0);
  CHECK(*rig.sample(3)[0] == doctest::Approx(1.66).epsilon(1e-9));
  CHECK(*rig.sample(3)[Dim - 1] == doctest::Approx(3).epsilon(1e-9));
}

template <int Dim>
void check_material_point() {
  Rig<Dim> rig(fmt::format(R"(
dimension: {}
resolution: 0.05
end_time: 1
gravity: 0
materials: [{{name: rubber, type: elastic, density: 1000, youngs_modulus: 1 MPa}}]
bodies: [{{name: block, material: rubber,
     shape: {{type: box, min: [0, 0, 0], max: [1, 0.3, 0.4]}}}}]
probes:
  - {{name: inside, type: material_point, body: block, at: [0.43, 0.15, 0.21]}}
  - {{name: corner, type: material_point, body: block, at: [1, 0.15, 0.4]}}
  - {{name: energy, type: energy, set: solids}}
  - {{name: amount, type: mean, set: solids, field: mass}}
  - {{name: u, type: mean, set: solids, field: displacement.x}}
)",
                           Dim));
  rig.plan_it();
  auto& set = rig.world.set("solids");
  const auto u = [](const Vec3& x) {
    return Vec3(0.01 + 0.2 * x.x() - 0.1 * x.z(), 0, 0.3 * x.z());
  };
  const auto v = [](const Vec3& x) { return Vec3(2 - x.z(), 0, 1 + 3 * x.x()); };
  for (Index i = 0; i < set.size(); ++i) {
    const Vec3 x = to_space<Dim>(set.vector(fields::reference_position)[i]);
    set.vector(fields::position)[i] = to_scene<Dim>(x + u(x));
    set.vector(fields::velocity)[i] = to_scene<Dim>(v(x));
  }
  observe(rig);
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 at = dynamic_cast<const Probe&>(*rig.model.probes[k]).positions()[0];
    const auto out = rig.sample(k);
    REQUIRE(out.size() == 2 * Dim);
    CHECK(*out[0] == doctest::Approx(u(at).x()).epsilon(1e-9));
    CHECK(*out[Dim - 1] == doctest::Approx(u(at).z()).epsilon(1e-9));
    CHECK(*out[Dim] == doctest::Approx(v(at).x()).epsilon(1e-9));
    CHECK(*out[2 * Dim - 1] == doctest::Approx(v(at).z()).epsilon(1e-9));
  }
  // sum of m |v|^2 / 2 over a lattice: (2 - z)^2 + (1 + 3 x)^2 at the centres of the cells.
  const double dp = 0.05, mass = 1000 * 0.4 * (Dim == 2 ? 1 : 0.3);
  const auto mean_square = [&](double length) { return length * length / 12 - dp * dp / 12; };
  const double square = 1.8 * 1.8 + mean_square(0.4) + 2.5 * 2.5 + 9 * mean_square(1);
  CHECK(*rig.sample(2)[0] == doctest::Approx(0.5 * mass * square).epsilon(1e-9));
  CHECK(*rig.sample(3)[0] * *rig.sample(3)[3] == doctest::Approx(mass));
  CHECK(*rig.sample(4)[0] == doctest::Approx(0.01 + 0.2 * 0.5 - 0.1 * 0.2));
}

}  // namespace

TEST_SUITE("probes") {
  TEST_CASE("sums over soil: amount, flux, moments, energy, front") {
    check_soil_sums<2>();
    check_soil_sums<3>();
  }

  TEST_CASE("points in soil: stress and velocity of linear fields") {
    check_soil_points<2>();
    check_soil_points<3>();
  }

  TEST_CASE("points of a solid, and its energy and displacement") {
    check_material_point<2>();
    check_material_point<3>();
  }

  TEST_CASE("mean of scalars and components, over a region and over another") {
    const std::string low = "{type: box, min: [-1, -1, -1], max: [2, 2, 0.4]}",
                      high = "{type: box, min: [-1, -1, 0.4], max: [2, 2, 1]}";
    Rig<2> rig(bed(2, "  - {name: s, type: mean, set: soil, field: stress.zz, region: " + high +
                          ", over: " + low +
                          "}\n"
                          "  - {name: v, type: mean, set: soil, field: velocity.x}\n"
                          "  - {name: n, type: mean, set: soil, field: volume_fraction}\n"
                          "  - {name: none, type: mean, set: soil, field: mass, region: {type: "
                          "box, min: [5, 0, 0], max: [6, 1, 1]}}\n"));
    rig.plan_it();
    for (Index i = 0; i < rig.soil().size(); ++i) {
      const Vec<2> x = rig.soil().vector(fields::position)[i];
      rig.soil().tensor(fields::stress)[i] << 0, 0, 1000 * (x[1] - 0.8), 0, 0, 0;
      rig.soil().vector(fields::velocity)[i] = {3 * x[0], 7};
    }
    observe(rig);
    const auto s = rig.sample(0);
    CHECK(*s[0] == doctest::Approx(-200));  // at z = 0.6, the middle of the upper half
    CHECK(*s[1] == doctest::Approx(-375));  // the lowest row, half a spacing above 0.4
    CHECK(*s[2] == doctest::Approx(-25));
    CHECK(*s[3] == 20.0 * 8);
    CHECK(*s[4] == doctest::Approx(1.0 / 3));  // -200 over -600
    CHECK(*rig.sample(1)[0] == doctest::Approx(1.5));
    CHECK(*rig.sample(2)[0] == doctest::Approx(0.6));
    CHECK_FALSE(rig.sample(3)[0].has_value());
    CHECK(*rig.sample(3)[3] == 0.0);
  }

  TEST_CASE("displacement of soil is the way since t = 0, and is kept only where it is asked for") {
    const std::string probe = ", type: mean, set: soil, field: displacement.";
    Rig<2> rig(bed(2, "  - {name: ux" + probe + "x}\n  - {name: uz" + probe + "z}\n"),
               {"bodies[0].velocity=[0.5, 0, 0]"});
    rig.plan_it();
    observe(rig);
    CHECK(*rig.sample(0)[0] == 0.0);
    rig.advance(40);
    observe(rig);
    const double t = rig.world.clock.time;
    CHECK(t > 0.01);
    CHECK(*rig.sample(0)[0] == doctest::Approx(0.5 * t).epsilon(1e-9));
    CHECK(*rig.sample(1)[0] == doctest::Approx(-0.5 * 9.81 * t * t).epsilon(0.02));
    Rig<2> without(bed(2, "  - {name: a, type: amount, set: soil}\n"));
    without.plan_it();
    CHECK_FALSE(without.soil().has(fields::reference_position));
    CHECK_FALSE(without.soil().has(fields::displacement));
  }

  TEST_CASE("run-out, height and slope of a wedge of soil, and its profile") {
    const std::string wedge =
        "{type: prism, y_min: 0, y_max: 0.5, points: [[0, 0, 0], [2, 0, 0], [0, 0, 1]]}";
    Rig<2> rig(bed(2,
                   "  - {name: d, type: deposit}\n"
                   "  - {name: p, type: surface_profile, from: [0.4, 0, 0], to: [1.4, 0, 0], "
                   "points: 6}\n",
                   wedge),
               {"resolution=0.02"});
    rig.plan_it();
    observe(rig);
    const auto d = rig.sample(0);
    CHECK(*d[0] == doctest::Approx(2).epsilon(0.06));  // the tip is thinner than two particles
    CHECK(*d[1] == doctest::Approx(1).epsilon(0.03));
    CHECK(*d[2] == doctest::Approx(1).epsilon(0.03));
    const double slope = std::atan(0.5) * 180 / std::numbers::pi;
    CHECK(*d[3] == doctest::Approx(slope).epsilon(0.03));
    const auto p = rig.sample(1);
    for (std::size_t k = 0; k < 6; ++k)
      CHECK(std::abs(*p[k] - (0.8 - 0.1 * static_cast<double>(k))) < 0.5 * 0.02);
    CHECK(*p[6] == doctest::Approx(-slope).epsilon(0.02));
  }

  TEST_CASE("a sum of probes is empty where one of them is, and takes factors") {
    Rig<2> rig(bed(2,
                   "  - {name: a, type: amount, set: soil}\n"
                   "  - {name: b, type: amount, set: soil}\n"
                   "  - {name: in, type: stress, at: [0.5, 0, 0.4]}\n"
                   "  - {name: dry, type: stress, at: [5, 0, 0.4]}\n"
                   "  - {name: twice, type: sum, of: [a, b]}\n"
                   "  - {name: much, type: sum, of: [twice, a], factors: [10, -1]}\n"
                   "  - {name: none, type: sum, of: [in, dry]}\n"));
    rig.plan_it();
    observe(rig);
    const double mass = 0.6 * 2600 * 0.8;
    CHECK(*rig.sample(4)[0] == doctest::Approx(2 * mass));
    CHECK(*rig.sample(5)[0] == doctest::Approx(19 * mass));
    CHECK_FALSE(rig.sample(6)[0].has_value());
    CHECK(rig.sample(6)[10].has_value());
  }

  TEST_CASE("torques about two points are not added") {
    for (const bool same : {true, false}) {
      const Model model = read_deck_text(
          "dimension: 2\nresolution: 0.1\nend_time: 1\n"
          "materials: [{name: water, type: water}]\n"
          "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 1, "
          "0.5]}}]\n"
          "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 1, 1], open: [top]}]\n"
          "probes:\n"
          "  - {name: a, type: force, boundary: tank, about: [0, 0, 0.25]}\n"
          "  - {name: b, type: force, boundary: tank, about: [" +
          std::string(same ? "0" : "1") +
          ", 0, 0.25]}\n"
          "  - {name: both, type: sum, of: [a, b]}\n");
      Diagnostics found;
      const Scene<2> scene = build_scene<2>(model, found);
      check_scene(scene, found);
      CHECK(found.has_errors() != same);
      if (!same) CHECK(found.render().find("about another point") != std::string::npos);
    }
  }
}
