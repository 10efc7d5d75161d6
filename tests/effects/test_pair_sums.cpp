// The pair sums of the water against all pairs, computed here once more from the paper.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <numbers>

#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

constexpr double c0 = 20, rho0 = 1000, eta = 3, xi = 3;

std::string block_deck(int dimension, const std::string& precision, const std::string& gravity) {
  // A swirl that closes some pairs fast enough to saturate the limiter and opens others.
  return fmt::format(R"(
dimension: {}
resolution: {}
gravity: {}
end_time: 1
materials: [{{name: water, type: water, density: 1000, viscosity: 3, sound_speed: 20}}]
bodies:
  - name: block
    material: water
    shape: {{type: box, min: [0, 0, 0], max: [1, 1, 1]}}
    velocity: [8*sin(9*z) + x, {}, 7*sin(11*x) - z]
    pressure: 2e4*sin(5*x)*cos(7*z) + 1e4
numerics: {{pair_precision: {}, transport_velocity: false, density_reinitialization: none}}
)",
                     dimension, dimension == 2 ? 0.05 : 0.125, gravity,
                     dimension == 2 ? "0" : "5*cos(8*x)", precision);
}

// The Wendland kernel of Eq. 102, written down independently: dW/dr.
double kernel_slope(int dim, double r, double h) {
  const double q = r / h;
  if (q >= 2) return 0;
  const double c =
      dim == 2 ? 7 / (4 * std::numbers::pi * h * h) : 21 / (16 * std::numbers::pi * h * h * h);
  return c / h * -5 * q * std::pow(1 - q / 2, 3);
}

template <int Dim>
struct Expected {
  std::vector<Vec<Dim>> acceleration;
  std::vector<double> rate;
};

// Eqs. 58 and 60 to 63 with n^w = 1 and no soil; the jump of pressure in Eq. 58 is that beyond
// hydrostatics, rho0 g . (r_i - r_j).
template <int Dim>
Expected<Dim> all_pairs(Rig<Dim>& rig) {
  const ParticleSet<Dim>& water = rig.water();
  const auto& x = water.vector(fields::position);
  const auto& v = water.vector(fields::velocity);
  const auto& rho = water.scalar(fields::density);
  const auto& m = water.scalar(fields::mass);
  const double h = 1.8 * rig.model.resolution;
  const Vec<Dim> g = to_scene<Dim>(rig.model.gravity);
  Expected<Dim> out;
  for (Index i = 0; i < water.size(); ++i) {
    Vec<Dim> a = g;
    double divergence = 0, dissipation = 0;
    const double p_i = c0 * c0 * (rho[i] - rho0);
    for (Index j = 0; j < water.size(); ++j) {
      const Vec<Dim> r = x[i] - x[j];
      const double length = r.norm();
      if (i == j || length >= 2 * h) continue;
      const double p_j = c0 * c0 * (rho[j] - rho0), volume = m[j] / rho[j];
      const Vec<Dim> e = r / length, gradient = kernel_slope(Dim, length, h) * e;
      const double u_l = -v[i].dot(e), u_r = -v[j].dot(e), z = rho0 * c0;
      const double beta = std::min(xi * std::max((rho0 + rho0) * (u_l - u_r) / (z + z), 0.0), 1.0);
      const double p_star = (z * p_j + z * p_i + beta * z * z * (u_l - u_r)) / (z + z);
      a -= 2 / rho[i] * p_star * volume * gradient;
      a += eta * 2 * r.dot(gradient) / (length * length + 0.01 * h * h) * volume / rho[i] *
           (v[i] - v[j]);
      divergence += (v[i] - v[j]).dot(gradient) * volume;
      const double jump = p_i - p_j - rho0 * g.dot(r);
      dissipation += 2 * jump / (z + z) * kernel_slope(Dim, length, h) * volume;
    }
    out.acceleration.push_back(a);
    out.rate.push_back(rho[i] * (divergence + dissipation));
  }
  return out;
}

template <int Dim>
void compare(const std::string& precision, const std::string& gravity, double tolerance) {
  Rig<Dim> rig(block_deck(Dim, precision, gravity));
  rig.jitter(0.3);
  rig.plan_it();
  rig.freeze();
  rig.plan->run(Stage::force);
  rig.plan->run(Stage::rate);
  const Expected<Dim> expected = all_pairs(rig);
  const auto& a = rig.water().vector(fields::acceleration_sum);
  const auto& rate = rig.water().scalar(fields::density_rate);
  double off = 0, size = 0, off_rate = 0, size_rate = 0;
  for (Index i = 0; i < rig.water().size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    off = std::max(off, (a[i] - expected.acceleration[k]).norm());
    size = std::max(size, expected.acceleration[k].norm());
    off_rate = std::max(off_rate, std::abs(rate[i] - expected.rate[k]));
    size_rate = std::max(size_rate, std::abs(expected.rate[k]));
  }
  INFO(Dim, "D ", precision, ": momentum ", off / size, ", continuity ", off_rate / size_rate);
  CHECK(size > 300);
  CHECK(size_rate > 300);
  CHECK(off < tolerance * size);
  CHECK(off_rate < tolerance * size_rate);
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE("momentum and continuity of the water equal all pairs of Eqs. 58 to 63") {
    compare<2>("double", "0", 1e-12);
    compare<3>("double", "0", 1e-12);
    compare<2>("single", "0", 1e-5);
    compare<3>("single", "0", 1e-5);
  }

  TEST_CASE("with gravity the density dissipation sees the pressure beyond hydrostatics") {
    compare<2>("double", "[3, -9.81]", 1e-12);
    compare<3>("double", "[3, 2, -9.81]", 1e-12);
    compare<3>("single", "[3, 2, -9.81]", 1e-5);
  }
}
