#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/hash.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

double random_of_soil(Index i, int k) {
  return 2 * random_uniform(23, static_cast<std::uint64_t>(16 * i + k)) - 1;
}

// A free block of soil; `more` goes to the end of the deck.
std::string soil_block(int dimension, const std::string& material, const std::string& more = "",
                       const std::string& body = "") {
  return fmt::format(R"(
dimension: {}
resolution: 0.1
gravity: 0
end_time: 1
materials: [{{name: soil, type: soil, density: 2000, volume_fraction: 0.8, youngs_modulus: 1e6,
    poisson_ratio: 0.3, {}}}]
bodies:
  - name: block
    material: soil
    shape: {{type: box, min: [0, 0, 0], max: [0.8, 0.7, 0.9]}}
    {}
{})",
                     dimension, material, body, more);
}

const char* const exact_soil =
    "numerics: {pair_precision: double, volume_fraction_reinitialization: none}";

// A velocity that is linear in space, with all components of its gradient.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> slope() {
  Eigen::Matrix<double, Dim, Dim> g;
  for (int a = 0; a < Dim; ++a)
    for (int b = 0; b < Dim; ++b) g(a, b) = 0.1 * (1 + a) - 0.25 * b + 0.07 * a * b;
  return g;
}

template <int Dim>
void disturb(Rig<Dim>& rig, bool stress, double by = 0.2) {
  rig.jitter_set("soil", by);
  for (Index i = 0; i < rig.soil().size(); ++i) {
    for (int k = 0; k < Dim; ++k) rig.soil().vector(fields::velocity)[i][k] = random_of_soil(i, k);
    if (!stress) continue;
    for (int k = 0; k < 6; ++k)
      rig.soil().tensor(fields::stress)[i][k] = 1e4 * random_of_soil(i, 4 + k);
    if (Dim == 2)
      rig.soil().tensor(fields::stress)[i][3] = rig.soil().tensor(fields::stress)[i][4] = 0;
  }
}

template <int Dim>
void check_momentum(const std::string& numerics, double tolerance) {
  Rig<Dim> rig(soil_block(Dim, "friction_angle: 30 deg", numerics));
  disturb(rig, true);
  rig.plan_it();
  rig.world.clock.dt_acoustic = 0;
  rig.plan->run(Stage::predict);
  rig.plan->run(Stage::force);
  Vec<Dim> sum = Vec<Dim>::Zero();
  double size = 0;
  for (Index i = 0; i < rig.soil().size(); ++i) {
    const Vec<Dim> f =
        rig.soil().scalar(fields::mass)[i] * rig.soil().vector(fields::acceleration_sum)[i];
    sum += f;
    size += f.norm();
  }
  CHECK(size > 0);
  CHECK(sum.norm() <= tolerance * size);
}

template <int Dim>
void check_gradient() {
  Rig<Dim> rig(soil_block(Dim, "plasticity: none", exact_soil));
  rig.jitter_set("soil", 0.1);
  const Eigen::Matrix<double, Dim, Dim> g = slope<Dim>();
  for (Index i = 0; i < rig.soil().size(); ++i)
    rig.soil().vector(fields::velocity)[i] = g * rig.soil().vector(fields::position)[i];
  rig.plan_it();
  rig.world.clock.dt_acoustic = 0;
  rig.plan->run(Stage::predict);
  rig.plan->run(Stage::force);
  // The stress starts from zero, so that one step gives the elastic stress of the strain rate.
  const double dt = 1e-5, young = 1e6, nu = 0.3;
  const double bulk = young / (3 * (1 - 2 * nu)), shear = young / (2 * (1 + nu));
  rig.world.clock.dt_acoustic = dt;
  rig.apply("soil_stress");
  Mat3 rate = Mat3::Zero();
  constexpr int axis[3] = {0, Dim == 3 ? 1 : 2, 2};
  for (int a = 0; a < Dim; ++a)
    for (int b = 0; b < Dim; ++b) rate(axis[a], axis[b]) = 0.5 * (g(a, b) + g(b, a));
  const Mat3 expected =
      dt * (2 * shear * rate + (bulk - 2 * shear / 3) * rate.trace() * Mat3::Identity());
  for (Index i = 0; i < rig.soil().size(); ++i) {
    const Sym3& s = rig.soil().tensor(fields::stress)[i];
    Mat3 full;
    full << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    CHECK((full - expected).norm() <= 1e-9 * expected.norm());
  }
}

// Twice the elastic energy of a stress, times the volume.
double elastic_energy(const Sym3& s, double young, double nu) {
  const double trace = s[0] + s[1] + s[2];
  const double square =
      s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
  return ((1 + nu) * square - nu * trace * trace) / young;
}

// The power of the forces is what the elastic energy takes up, particle by particle disturbed as
// they may be.
template <int Dim>
void check_power(const std::string& more) {
  Rig<Dim> rig(soil_block(Dim, "plasticity: none",
                          "numerics: {pair_precision: double, limiter_soil: 0, "
                          "volume_fraction_reinitialization: none}" +
                              more));
  disturb(rig, true, 0.1);  // no nearer to walls than contact begins
  rig.plan_it();
  rig.world.clock.dt_acoustic = 0;
  rig.plan->run(Stage::predict);
  rig.apply("soil_stress");  // with no step: the corrections of these places
  rig.plan->run(Stage::predict);
  rig.plan->run(Stage::force);
  auto& soil = rig.soil();
  double power = 0, size = 0, before = 0, after = 0;
  for (Index i = 0; i < soil.size(); ++i) {
    const double one = soil.scalar(fields::mass)[i] * soil.vector(fields::acceleration_sum)[i].dot(
                                                          soil.vector(fields::velocity)[i]);
    power += one;
    size += std::abs(one);
    before += 0.5 * soil.scalar(fields::volume)[i] *
              elastic_energy(soil.tensor(fields::stress)[i], 1e6, 0.3);
  }
  const double dt = 1e-9;
  rig.world.clock.dt_acoustic = dt;
  rig.apply("soil_stress");
  for (Index i = 0; i < soil.size(); ++i)
    after += 0.5 * soil.scalar(fields::volume)[i] *
             elastic_energy(soil.tensor(fields::stress)[i], 1e6, 0.3);
  CHECK(size > 0);
  CHECK((after - before) / dt == doctest::Approx(-power).epsilon(1e-5).scale(size));
}

// A block in a tank that it fills: force on the soil by walls and force on the walls.
template <int Dim>
void check_reaction(const std::string& slip) {
  Rig<Dim> rig(soil_block(Dim, "friction_angle: 30 deg",
                          fmt::format(R"(
numerics: {{pair_precision: double, limiter_soil: 5}}
boundaries: [{{name: box, type: tank, min: [0, 0, 0], max: [0.8, 0.7, 0.9], open: [top], slip: {}}}]
probes: [{{name: push, type: force, boundary: box}}]
)",
                                      slip)));
  disturb(rig, true);
  rig.plan_it();
  rig.world.clock.dt_acoustic = 0;
  rig.plan->run(Stage::predict);
  rig.plan->run(Stage::force);
  Vec<Dim> on_soil = Vec<Dim>::Zero();
  // Forces inside of the soil sum to zero, so the whole sum is that of the walls.
  for (Index i = 0; i < rig.soil().size(); ++i)
    on_soil += rig.soil().scalar(fields::mass)[i] * rig.soil().vector(fields::acceleration_sum)[i];
  rig.world.clock.time = 1;  // one step, which is the mean
  const auto out = rig.sample(0);
  CHECK(on_soil.norm() > 1);
  for (int k = 0; k < Dim; ++k)
    CHECK(*out[static_cast<std::size_t>(k)] ==
          doctest::Approx(-on_soil[k]).epsilon(1e-9).scale(on_soil.norm()));
}

}  // namespace

namespace {

// Grains 2.2 spacings apart fly towards each other: nothing stops them where their kernels meet,
// only where they are dense.
template <int Dim>
void check_scattered() {
  for (const double apart : {2.2, 1.02}) {
    Rig<Dim> rig(soil_block(Dim, "friction_angle: 30 deg"));
    const Vec<Dim> middle = Vec<Dim>::Constant(0.4);
    auto& x = rig.soil().vector(fields::position);
    auto& v = rig.soil().vector(fields::velocity);
    for (Index i = 0; i < x.size(); ++i) {
      x[i] = middle + apart * (x[i] - middle);
      v[i] = -2 * (x[i] - middle) / apart;
    }
    rig.plan_it();
    rig.world.rearrange();
    double most = 0;
    while (rig.world.clock.time < 0.2) {
      rig.advance(1);
      for (Index i = 0; i < x.size(); ++i)
        most = std::max(most, rig.soil().tensor(fields::stress)[i].norm());
    }
    CAPTURE(Dim);
    if (apart > 2) CHECK(most == 0);
    else CHECK(most > 1e3);
  }
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("soil: forces between particles sum to zero") {
    check_momentum<2>(exact_soil, 1e-13);
    check_momentum<3>(exact_soil, 1e-13);
    check_momentum<2>("", 1e-6);
    check_momentum<3>("", 1e-6);
  }

  TEST_CASE("soil: the power of the forces is what the elastic energy takes up, also at walls") {
    check_power<2>("");
    check_power<3>("");
    for (const char* slip : {"no_slip", "free_slip"}) {
      const std::string tank = fmt::format(
          "\nboundaries: [{{name: box, type: tank, min: [0, 0, 0], max: [0.8, 0.7, 1.5], open: "
          "[top], slip: {}}}]",
          slip);
      check_power<2>(tank);
      check_power<3>(tank);
    }
  }

  TEST_CASE("soil: unlike soils exchange momentum exactly") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.1
gravity: 0
end_time: 1
materials:
  - {name: soft, type: soil, density: 2000, volume_fraction: 0.8, youngs_modulus: 1e6,
      friction_angle: 30 deg}
  - {name: stiff, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 2e7,
      friction_angle: 40 deg, cohesion: 1 kPa}
bodies:
  - {name: low, material: soft, shape: {type: box, min: [0, 0, 0], max: [0.8, 0, 0.5]}}
  - {name: high, material: stiff, shape: {type: box, min: [0, 0, 0.5], max: [0.8, 0, 0.9]}}
numerics: {pair_precision: double}
)");
    disturb(rig, true);
    rig.plan_it();
    rig.world.clock.dt_acoustic = 0;
    rig.plan->run(Stage::predict);
    rig.plan->run(Stage::force);
    Vec<2> sum = Vec<2>::Zero();
    double size = 0;
    for (Index i = 0; i < rig.soil().size(); ++i) {
      const Vec<2> f =
          rig.soil().scalar(fields::mass)[i] * rig.soil().vector(fields::acceleration_sum)[i];
      sum += f;
      size += f.norm();
    }
    CHECK(sum.norm() <= 1e-13 * size);
  }

  TEST_CASE("soil: the stress of a linear velocity is exact, also at faces and corners") {
    check_gradient<2>();
    check_gradient<3>();
  }

  TEST_CASE("soil: force on walls is the reaction of the force on soil") {
    for (const char* slip : {"no_slip", "free_slip"}) {
      CAPTURE(slip);
      check_reaction<2>(slip);
      check_reaction<3>(slip);
    }
  }

  TEST_CASE("soil: grains that have come apart bear nothing until they are packed again") {
    check_scattered<2>();
    check_scattered<3>();
  }

  TEST_CASE("soil: a block that drifts keeps everything but its place") {
    Rig<2> rig(
        soil_block(2, "friction_angle: 30 deg",
                   "numerics: {pair_precision: double, volume_fraction_reinitialization: none}",
                   "velocity: [3, 0, -2]"));
    rig.plan_it();
    rig.advance(20);
    for (Index i = 0; i < rig.soil().size(); ++i) {
      CHECK(rig.soil().tensor(fields::stress)[i].norm() <= 1e-6);
      CHECK(rig.soil().scalar(fields::volume_fraction)[i] == doctest::Approx(0.8).epsilon(1e-12));
    }
  }

  TEST_CASE("soil: a fixed skeleton stays, and nothing is computed for it") {
    Rig<2> rig(
        soil_block(2, "friction_angle: 30 deg, skeleton: fixed", "", "velocity: [3, 0, -2]"));
    const auto of_id = [&](Id id) {
      for (Index i = 0; i < rig.soil().size(); ++i)
        if (rig.soil().ids()[i] == id) return rig.soil().vector(fields::position)[i];
      return Vec<2>(NAN, NAN);
    };
    rig.plan_it();
    const Vec<2> before = of_id(7);
    rig.advance(5);
    CHECK(of_id(7) == before);
    for (const auto& e : rig.plan->effects()) {
      CHECK(e.info.name != "soil_momentum");
      CHECK(e.info.name != "soil_stress");
    }
  }

  TEST_CASE("soil: the plastic work of a collapsing heap is never negative, and mass stays") {
    Rig<2> rig(R"(
dimension: 2
resolution: 0.02
gravity: 9.81
end_time: 1
materials: [{name: soil, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 5e6,
    friction_angle: 25 deg}]
bodies: [{name: column, material: soil, shape: {type: box, min: [0, 0, 0], max: [0.2, 0, 0.3]}}]
boundaries: [{name: floor, type: tank, min: [0, 0, 0], max: [1, 0, 0.4], open: [top]}]
)");
    rig.plan_it();
    std::vector<double> before(static_cast<std::size_t>(rig.soil().size()), 0);
    double least = 0, most = 0;
    for (int k = 0; k < 40; ++k) {
      rig.advance(5);
      for (Index i = 0; i < rig.soil().size(); ++i) {
        double& old = before[static_cast<std::size_t>(rig.soil().ids()[i])];
        const double now = rig.soil().scalar(fields::plastic_work)[i];
        least = std::min(least, now - old);
        most = std::max(most, now - old);
        old = now;
      }
    }
    CHECK(most > 0);
    CHECK(least >= -1e-12 * most);
  }

}  // TEST_SUITE
