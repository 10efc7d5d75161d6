#include <doctest/doctest.h>

#include <fmt/format.h>

#include <numbers>

#include "core/parallel.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

// A pool of water without walls, so that its faces end the support as walls do.
std::string pool(int dimension, const std::string& probes, const std::string& body = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.05
end_time: 1
materials: [{{name: water, type: water, density: 1000, sound_speed: 50}}]
bodies:
  - name: pool
    material: water
    shape: {{type: box, min: [0, 0, 0], max: [1, 0.5, 0.8]}}
    {}
numerics: {{transport_velocity: false}}
probes:
{})",
                     dimension, body, probes);
}

const char* const flat_points = R"(
  - {name: inside, type: pressure, at: [0.43, 0.2, 0.37]}
  - {name: at_face, type: pressure, at: [0, 0.25, 0.41]}
  - {name: at_floor, type: pressure, at: [0.52, 0.25, 0]}
  - {name: in_corner, type: pressure, at: [1, 0.5, 0]}
  - {name: speed, type: velocity, at: [0, 0.1, 0.33]}
  - {name: outside, type: pressure, at: [1.3, 0.2, 0.4]}
  - {name: speed_outside, type: velocity, at: [0.5, 0.2, 1.1]}
)";

// Linear fields on particles that do not lie on a lattice, through the fit of the probes.
template <int Dim>
void check_fit() {
  Rig<Dim> rig(pool(Dim, flat_points));
  rig.jitter(0.2);
  rig.plan_it();
  rig.freeze();
  const auto p = [](const Vec3& x) { return 100 + 30 * x.x() - 70 * x.y() - 900 * x.z(); };
  const auto v = [](const Vec3& x) { return Vec3(1 + 2 * x.z(), x.x() - x.y(), 3 - x.x()); };
  for (Index i = 0; i < rig.water().size(); ++i) {
    const Vec3 x = to_space<Dim>(rig.water().vector(fields::position)[i]);
    rig.water().scalar(fields::pressure)[i] = p(x);
    rig.water().vector(fields::velocity)[i] = to_scene<Dim>(v(x));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    const auto out = rig.sample(k);
    const auto& probe = dynamic_cast<const Probe&>(*rig.model.probes[k]);
    REQUIRE(out[0].has_value());
    CHECK(*out[0] == doctest::Approx(p(probe.positions()[0])).epsilon(1e-9));
    // The share of the kernel: all inside, a half on a face, a quarter on an edge, an eighth in a
    // corner of 3D.
    const double full = k == 0 ? 1 : k < 3 ? 0.5 : Dim == 2 ? 0.25 : 0.125;
    CHECK(*out[1] == doctest::Approx(full).epsilon(0.2));
  }
  const auto speed = rig.sample(4);
  const Vec3 expected = v(dynamic_cast<const Probe&>(*rig.model.probes[4]).positions()[0]);
  REQUIRE(speed.size() == Dim);
  for (int k = 0; k < Dim; ++k)
    CHECK(*speed[static_cast<std::size_t>(k)] ==
          doctest::Approx(to_scene<Dim>(expected)[k]).epsilon(1e-9));
  // No support: empty, not zero.
  CHECK_FALSE(rig.sample(5)[0].has_value());
  CHECK(*rig.sample(5)[1] == 0.0);
  CHECK_FALSE(rig.sample(6)[0].has_value());
}

}  // namespace

TEST_SUITE("probes") {
  TEST_CASE("point probes are exact for linear fields, also where half of the water is missing") {
    check_fit<2>();
  }

  TEST_CASE("point probes in 3D") {
    // In a corner of 3D an eighth of the kernel is below the bound of a measurement.
    std::string points = flat_points;
    points.replace(points.find("at: [1, 0.5, 0]"), 15, "at: [1, 0.3, 0]");
    Rig<3> rig(pool(3, points));
    rig.plan_it();
    rig.freeze();
    for (Index i = 0; i < rig.water().size(); ++i) {
      const Vec3 x = rig.water().vector(fields::position)[i];
      rig.water().scalar(fields::pressure)[i] = 100 + 30 * x.x() - 70 * x.y() - 900 * x.z();
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 x = dynamic_cast<const Probe&>(*rig.model.probes[k]).positions()[0];
      REQUIRE(rig.sample(k)[0].has_value());
      CHECK(*rig.sample(k)[0] ==
            doctest::Approx(100 + 30 * x.x() - 70 * x.y() - 900 * x.z()).epsilon(1e-9));
    }
    CHECK(rig.sample(4).size() == 3);
  }

  TEST_CASE("the water level of a lattice block is its top to a tenth of a spacing") {
    Rig<2> rig(pool(2,
                    "  - {name: a, type: water_level, at: [0.5, 0, 0]}\n"
                    "  - {name: b, type: water_level, at: [0.513, 0, 7]}\n"
                    "  - {name: dry, type: water_level, at: [3, 0, 0]}\n"));
    rig.plan_it();
    rig.freeze();
    const double a = *rig.sample(0)[0], b = *rig.sample(1)[0];
    INFO("level off by ", (a - 0.8) / 0.05, " and ", (b - 0.8) / 0.05, " spacings");
    CHECK(std::abs(a - 0.8) < 0.1 * 0.05);
    CHECK(std::abs(b - 0.8) < 0.1 * 0.05);
    CHECK_FALSE(rig.sample(2)[0].has_value());
    Rig<3> cube(pool(3, "  - {name: a, type: water_level, at: [0.5, 0.25, 0]}\n"));
    cube.plan_it();
    cube.freeze();
    CHECK(std::abs(*cube.sample(0)[0] - 0.8) < 0.1 * 0.05);
  }

  TEST_CASE("a drop above the surface is not the water level") {
    Rig<2> rig(pool(2, "  - {name: a, type: water_level, at: [0.5, 0, 0]}\n"));
    const Index i = test::particle_at<2>(rig.water(), {0.525, 0.475});
    REQUIRE(i >= 0);
    rig.water().vector(fields::position)[i] = {0.51, 1.2};
    rig.plan_it();
    rig.freeze();
    REQUIRE(rig.sample(0)[0].has_value());
    CHECK(std::abs(*rig.sample(0)[0] - 0.8) < 0.25 * 0.05);
  }

  TEST_CASE("the front is the foremost particle plus half a spacing, in a direction and a region") {
    Rig<2> rig(
        pool(2,
             "  - {name: right, type: front}\n"
             "  - {name: up, type: front, direction: [0, 0, 2]}\n"
             "  - {name: left, type: front, direction: [-1, 0, 0]}\n"
             "  - {name: part, type: front, region_min: [0, 0, 0], region_max: [0.5, 1, 0.3]}\n"
             "  - {name: none, type: front, region_min: [2, 0, 0]}\n"
             "  - {name: slant, type: front, direction: [1, 0, 1]}\n"));
    rig.plan_it();
    CHECK(*rig.sample(0)[0] == doctest::Approx(1.0));
    CHECK(*rig.sample(1)[0] == doctest::Approx(0.8));
    CHECK(*rig.sample(2)[0] == doctest::Approx(0.0));
    CHECK(*rig.sample(3)[0] == doctest::Approx(0.5));
    CHECK_FALSE(rig.sample(4)[0].has_value());
    CHECK(*rig.sample(5)[0] == doctest::Approx((0.975 + 0.775) / std::sqrt(2.0) + 0.025));
  }

  TEST_CASE("the moments of a disc, an ellipse and a ball give their semi-axes back") {
    const std::string probe = "  - {name: m, type: moments}\n";
    const auto deck = [&](int dim, const std::string& shape, double dp) {
      return fmt::format(
          "dimension: {}\nresolution: {}\nend_time: 1\nmaterials: [{{name: w, type: water}}]\n"
          "bodies: [{{name: b, material: w, shape: {}}}]\nprobes:\n{}",
          dim, dp, shape, probe);
    };
    Rig<2> disc(deck(2, "{type: sphere, center: [0.3, 0, 0.7], radius: 0.5}", 0.02));
    disc.plan_it();
    const auto d = disc.sample(0);
    REQUIRE(d.size() == 5);
    CHECK(*d[0] == doctest::Approx(0.5).epsilon(0.005));
    CHECK(*d[1] == doctest::Approx(0.5).epsilon(0.005));
    CHECK(*d[2] == doctest::Approx(0.3).epsilon(0.002));
    CHECK(*d[3] == doctest::Approx(0.7).epsilon(0.002));
    CHECK(*d[4] == doctest::Approx(std::numbers::pi * 0.25).epsilon(0.01));
    Rig<2> ellipse(deck(2, "{type: ellipsoid, center: [0, 0, 0], semi_axes: [0.6, 1, 0.3]}", 0.02));
    ellipse.plan_it();
    CHECK(*ellipse.sample(0)[0] == doctest::Approx(0.6).epsilon(0.005));
    CHECK(*ellipse.sample(0)[1] == doctest::Approx(0.3).epsilon(0.01));
    Rig<3> ball(deck(3, "{type: sphere, center: [0, 1, 0], radius: 0.5}", 0.05));
    ball.plan_it();
    const auto b = ball.sample(0);
    REQUIRE(b.size() == 7);
    for (const std::size_t k : {0u, 1u, 2u}) CHECK(*b[k] == doctest::Approx(0.5).epsilon(0.01));
    CHECK(*b[4] == doctest::Approx(1).epsilon(0.005));
    CHECK(*b[6] == doctest::Approx(4 * std::numbers::pi / 3 * 0.125).epsilon(0.02));
  }

  TEST_CASE("the flux of a uniform stream is speed times area") {
    const std::string probes =
        "  - {name: all, type: flux, point: [0.5, 0.25, 0], normal: [3, 0, 0]}\n"
        "  - {name: back, type: flux, point: [0.5, 0.25, 0], normal: [-1, 0, 0]}\n"
        "  - {name: low, type: flux, point: [0.437, 0, 0], normal: [1, 0, 0], region_min: [0, 0, "
        "0], region_max: [1, 1, 0.4]}\n"
        "  - {name: up, type: flux, point: [0, 0, 0.4], normal: [0, 0, 1]}\n"
        "  - {name: dry, type: flux, point: [3, 0, 0], normal: [1, 0, 0]}\n";
    Rig<2> rig(pool(2, probes, "velocity: [1.5, 0, -0.25]"));
    rig.plan_it();
    rig.freeze();
    CHECK(*rig.sample(0)[0] == doctest::Approx(1.5 * 0.8));
    CHECK(*rig.sample(1)[0] == doctest::Approx(-1.5 * 0.8));
    CHECK(*rig.sample(2)[0] == doctest::Approx(1.5 * 0.4));
    CHECK(*rig.sample(3)[0] == doctest::Approx(-0.25 * 1.0));
    CHECK(*rig.sample(4)[0] == 0.0);
    Rig<3> cube(pool(3, probes, "velocity: [1.5, 0, -0.25]"));
    cube.plan_it();
    cube.freeze();
    CHECK(*cube.sample(0)[0] == doctest::Approx(1.5 * 0.8 * 0.5));
  }

  TEST_CASE("the flux of water in soil is that of the water alone") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.025
end_time: 1
materials:
  - {name: water, type: water, sound_speed: 50}
  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1e7,
     friction_angle: 30 deg, skeleton: fixed, drag: none}
bodies:
  - {name: pool, material: water, velocity: [0.5, 0, 0],
     shape: {type: box, min: [0, 0, 0], max: [1.2, 0, 0.4]}}
  - {name: plug, material: sand, shape: {type: box, min: [0.4, 0, 0], max: [0.8, 0, 0.4]}}
relaxation: {steps: 200}
probes:
  - {name: before, type: flux, point: [0.2, 0, 0], normal: [1, 0, 0]}
  - {name: inside, type: flux, point: [0.6, 0, 0], normal: [1, 0, 0]}
)");
    rig.plan_it();
    rig.freeze();
    CHECK(*rig.sample(0)[0] == doctest::Approx(0.5 * 0.4).epsilon(0.02));
    CHECK(*rig.sample(1)[0] == doctest::Approx(0.5 * 0.4 * 0.4).epsilon(0.03));
    CHECK(*rig.sample(1)[1] == doctest::Approx(1000 * *rig.sample(1)[0]).epsilon(0.01));
  }

  TEST_CASE("amount counts particles, mass and volume") {
    Rig<2> rig(pool(2, "  - {name: a, type: amount}\n"));
    rig.plan_it();
    for (Index i = 0; i < rig.water().size(); ++i) rig.water().scalar(fields::density)[i] = 1250;
    rig.freeze();
    CHECK(*rig.sample(0)[0] == doctest::Approx(800));
    CHECK(*rig.sample(0)[1] == doctest::Approx(0.64));
    CHECK(*rig.sample(0)[2] == 320.0);
    const auto columns = dynamic_cast<const Probe&>(*rig.model.probes[0]).columns(rig.model);
    CHECK(columns[0].unit == "kg/m");
    CHECK(columns[2].name == "count");
  }

  TEST_CASE("energies in closed form") {
    Rig<2> rig(pool(2, "  - {name: e, type: energy}\n", "velocity: [3, 0, 4]"));
    rig.plan_it();
    for (Index i = 0; i < rig.water().size(); ++i) rig.water().scalar(fields::density)[i] = 1001;
    rig.freeze();
    const auto e = rig.sample(0);
    CHECK(*e[0] == doctest::Approx(0.5 * 800 * 25));
    CHECK(*e[1] == doctest::Approx(800 * 9.81 * 0.4));
    // Integral of p / rho^2 from 1000 to 1001 with p = c0^2 (rho - rho0); about c0^2 (0.001)^2 / 2
    // per kg.
    const double per_mass = 2500 * (std::log(1.001) + 1 / 1.001 - 1);
    CHECK(*e[2] == doctest::Approx(800 * per_mass).epsilon(1e-9));
    CHECK(*e[2] == doctest::Approx(800 * 2500 * 0.5e-6).epsilon(0.01));
    CHECK(*e[3] == doctest::Approx(*e[0] + *e[1] + *e[2]));
  }

  TEST_CASE("a force probe sums the particles of its own boundary") {
    const std::string walls =
        "boundaries:\n  - {name: tank, type: tank, min: [0, 0, 0], max: [1, 0.5, 0.8]}\n"
        "  - {name: plate, type: wall, shape: {type: box, min: [1.5, 0, 0], max: [1.7, 1, 0.1]}}\n";
    Rig<2> rig(pool(2,
                    "  - {name: f, type: force, boundary: plate}\n  - {name: g, type: force, "
                    "boundary: tank}\n"
                    "  - {name: h, type: force, boundary: plate, about: [1.6, 7, 0.05]}\n") +
               walls);
    rig.plan_it();
    auto& force = rig.walls().vector(fields::mean_water_force);
    for (Index i = 0; i < force.size(); ++i) force[i] = Vec<2>(2, -3);
    CHECK_FALSE(rig.sample(0)[0].has_value());  // before the first step there is no mean
    rig.world.clock.time = 1;
    CHECK(*rig.sample(0)[0] == doctest::Approx(8 * 2.0));
    CHECK(*rig.sample(0)[1] == doctest::Approx(8 * -3.0));
    CHECK(*rig.sample(1)[0] == doctest::Approx(2.0 * static_cast<double>(force.size() - 8)));
    // z f_x - x f_z about the origin, and about the centre of the plate.
    CHECK(*rig.sample(0)[2] == doctest::Approx(0.05 * 16 + 1.6 * 24));
    CHECK(std::abs(*rig.sample(2)[2]) < 1e-12);
  }
}
