#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash.h"
#include "materials/drucker_prager.h"

using namespace sphgeo;

namespace {

using Constants = DruckerPrager<double>;
using Invariants = StressInvariants<double>;

constexpr double degree = std::numbers::pi / 180;

Constants soil(double phi, double c, double psi, double young = 1e7, double nu = 0.3) {
  namespace dp = drucker_prager;
  return with_strength(Constants{young / (3 * (1 - 2 * nu)), young / (2 * (1 + nu)),
                                 dp::slope(std::tan(phi)), dp::slope(std::tan(psi)), 0, 0},
                       dp::strength(c, std::tan(phi)));
}

struct Point {
  double stress[6] = {};
  double strain = 0, work = 0, least_work = 0, work_size = 0, outside = 0;

  static Point isotropic(double p) {
    Point a;
    for (int k = 0; k < 3; ++k) a.stress[k] = -p;
    return a;
  }
  double root() const { return std::sqrt(Invariants(stress).second); }
  double first() const { return Invariants(stress).first; }
  void step(const double (&gradient)[3][3], double dt, const Constants& m) {
    const auto plastic = update_stress(stress, gradient, dt, m);
    strain += plastic.strain;
    work += plastic.work;
    least_work = std::min(least_work, plastic.work);
    work_size = std::max(work_size, root() * plastic.strain);
    // How far the stress is outside of the yield surface, in parts of k_c or of the mean stress.
    const double f = m.friction * first() + root() - m.strength;
    outside = std::max(outside, f / std::max(m.strength, std::abs(first()) / 3 + 1e-300));
  }
  void walk(const double (&gradient)[3][3], double time, int steps, const Constants& m) {
    for (int k = 0; k < steps; ++k) step(gradient, time / steps, m);
  }
};

// Compression along z at rate 1 with a free lateral rate.
void compress(Point& p, double lateral, double time, int steps, const Constants& m) {
  const double gradient[3][3] = {{lateral, 0, 0}, {0, lateral, 0}, {0, 0, -1}};
  p.walk(gradient, time, steps, m);
}

void shear(Point& p, double time, int steps, const Constants& m) {
  const double gradient[3][3] = {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}};
  p.walk(gradient, time, steps, m);
}

double random(int k) { return 2 * random_uniform(11, static_cast<std::uint64_t>(k)) - 1; }

}  // namespace

TEST_SUITE("materials") {
  TEST_CASE(
      "each cone has the strength of Mohr and Coulomb in the loading that it is named after") {
    namespace dp = drucker_prager;
    const double phi = 35 * degree, cohesion = 2e3, side = 1e4, tangent = std::tan(phi),
                 sine = std::sin(phi);
    // sigma_1 at failure, pressures; the cone fails where sqrt(J2) = k - alpha I1.
    const double passive = (1 + sine) / (1 - sine),
                 axial = passive * side + 2 * cohesion * std::sqrt(passive);
    const auto excess = [&](double a, double b, double c, dp::ConeFit cone) {
      const double mean = (a + b + c) / 3;
      const double root = std::sqrt(
          0.5 * ((a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean)));
      return root / (dp::strength(cohesion, tangent, cone) + dp::slope(tangent, cone) * 3 * mean) -
             1;
    };
    CHECK(std::abs(excess(axial, side, side, dp::ConeFit::compression)) < 1e-12);
    CHECK(std::abs(excess(axial, axial, side, dp::ConeFit::extension)) < 1e-12);
    // Eq. 14 is weaker in both loadings than the one that is made for compression.
    CHECK(dp::slope(tangent) < dp::slope(tangent, dp::ConeFit::compression));
    CHECK(dp::slope(tangent) == doctest::Approx(tangent / std::sqrt(9 + 12 * tangent * tangent)));
  }

  TEST_CASE("elastic oedometer and shear follow Hooke's law") {
    Constants m = soil(0, 0, 0);
    m.friction = 0;
    m = with_strength(m, drucker_prager::unbounded);
    Point p;
    compress(p, 0, 1e-3, 7, m);
    CHECK(p.stress[2] == doctest::Approx(-(m.bulk + 4 * m.shear / 3) * 1e-3).epsilon(1e-12));
    CHECK(p.stress[0] == doctest::Approx(-(m.bulk - 2 * m.shear / 3) * 1e-3).epsilon(1e-12));
    CHECK(p.strain == 0);
    CHECK(p.work == 0);
    Point q;
    shear(q, 1e-4, 1000, m);
    CHECK(q.stress[5] == doctest::Approx(m.shear * 1e-4).epsilon(1e-8));
  }

  TEST_CASE(
      "oedometric yielding without dilation: the pressure stays elastic, the deviator follows it") {
    const Constants m = soil(10 * degree, 0, 0);
    Point p;
    compress(p, 0, 1e-3, 500, m);
    REQUIRE(2 * m.shear / std::sqrt(3.0) > 3 * m.bulk * m.friction);  // it does yield
    const double first = -3 * m.bulk * 1e-3;
    CHECK(p.first() == doctest::Approx(first).epsilon(1e-12));
    CHECK(p.root() == doctest::Approx(-m.friction * first).epsilon(1e-10));
    CHECK(p.stress[2] ==
          doctest::Approx(first / 3 + 2 / std::sqrt(3.0) * m.friction * first).epsilon(1e-10));
  }

  TEST_CASE(
      "simple shear from an isotropic state: strength, and growth of the shear stress with "
      "dilation") {
    const double phi = 30 * degree, p0 = 1e5, c = 2e3;
    SUBCASE("no dilation") {
      const Constants m = soil(phi, c, 0);
      Point p = Point::isotropic(p0);
      shear(p, 0.1, 4000, m);
      CHECK(p.root() == doctest::Approx(m.strength + 3 * m.friction * p0).epsilon(1e-10));
      CHECK(p.first() == doctest::Approx(-3 * p0).epsilon(1e-12));
      CHECK(p.strain == doctest::Approx(0.1 / std::sqrt(3.0)).epsilon(0.1));
    }
    SUBCASE("dilation") {
      for (const double psi : {10 * degree, phi}) {
        const Constants m = soil(phi, c, psi);
        const double yield = (m.strength + 3 * m.friction * p0) / m.shear, gamma = yield + 0.02;
        const double hardening = 9 * m.bulk * m.friction * m.dilation;
        const double exact = m.shear * yield + hardening * m.shear / (m.shear + hardening) * 0.02;
        // Pure shear: the turning of the stress in a simple shear is no part of the closed form.
        const double gradient[3][3] = {{0, 0, 0.5}, {0, 0, 0}, {0.5, 0, 0}};
        for (const int steps : {100, 400, 1600}) {
          Point p = Point::isotropic(p0);
          p.walk(gradient, gamma, steps, m);
          CAPTURE(steps);
          CHECK(std::abs(p.root() - exact) <
                exact / steps);  // of the step in which it begins to yield
        }
      }
    }
  }

  TEST_CASE("Euler's error falls at first order in the step, along a path that turns") {
    const Constants m = soil(30 * degree, 2e3, 10 * degree);
    const auto walk = [&](int steps) {
      Point p = Point::isotropic(1e5);
      for (int k = 0; k < steps; ++k) {
        const double angle = 3.0 * k / steps, a = std::cos(angle), b = std::sin(angle);
        const double gradient[3][3] = {
            {0.5 * b, 0.2, 0.5 * a}, {0, -0.1, 0}, {0.5 * a, 0.3 * b, -0.5 * b}};
        p.step(gradient, 0.05 / steps, m);
      }
      return p;
    };
    const Point exact = walk(409600);
    double before = 0;
    for (const int steps : {200, 400, 800, 1600}) {
      const Point p = walk(steps);
      double error = 0;
      for (int k = 0; k < 6; ++k)
        error = std::max(error, std::abs(p.stress[k] - exact.stress[k]) / 1e5);
      CAPTURE(steps);
      CHECK(error < 20.0 / steps);
      if (before > 0) CHECK(before / error == doctest::Approx(2).epsilon(0.15));
      before = error;
    }
  }

  TEST_CASE("triaxial compression reaches the closed-form strength") {
    const double phi = 30 * degree, lateral = 5e4, c = 1e3;
    const Constants m = soil(phi, c, 0);
    Point p = Point::isotropic(lateral);
    const int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      // The lateral rate that keeps the lateral stress: bisection.
      double lo = -1, hi = 5;
      for (int n = 0; n < 60; ++n) {
        const double rate = 0.5 * (lo + hi);
        Point trial = p;
        compress(trial, rate, 0.02 / steps, 1, m);
        (trial.stress[0] > -lateral ? hi : lo) = rate;
      }
      compress(p, 0.5 * (lo + hi), 0.02 / steps, 1, m);
    }
    const double q = (m.strength + 3 * m.friction * lateral) / (1 / std::sqrt(3.0) - m.friction);
    CHECK(p.stress[0] == doctest::Approx(-lateral).epsilon(1e-6));
    CHECK(p.stress[2] == doctest::Approx(-lateral - q).epsilon(1e-4));
  }

  TEST_CASE("corners: no friction, no cohesion, no deviator, dilation equal to friction") {
    struct Case {
      double phi, c, psi;
    };
    int seed = 0;
    for (const Case& k : {Case{0, 0, 0},
                          {0, 5e3, 0},
                          {30 * degree, 0, 0},
                          {30 * degree, 0, 30 * degree},
                          {30 * degree, 4e3, 0},
                          {30 * degree, 4e3, 30 * degree},
                          {1e-9, 1, 0}})
      for (const double nu : {0.0, 0.3, 0.49}) {
        CAPTURE(k.phi);
        CAPTURE(k.c);
        CAPTURE(k.psi);
        CAPTURE(nu);
        const Constants m = soil(k.phi, k.c, k.psi, 1e7, nu);
        for (const double p0 : {0.0, 1.0, 1e5}) {
          Point p = Point::isotropic(p0);
          for (int turn = 0; turn < 40; ++turn) {
            double gradient[3][3];
            for (auto& row : gradient)
              for (double& g : row) g = random(++seed);
            p.walk(gradient, 2e-3, 20, m);
          }
          for (const double s : p.stress) CHECK(std::isfinite(s));
          CHECK(p.outside <= 1e-10);
          // Associated flow without cohesion dissipates nothing: what is left is the error of a
          // step.
          CHECK(p.least_work >= -1e-9 * p.work_size);
          CHECK(p.work >= -1e-9 * p.work_size);
        }
      }
  }

  TEST_CASE("tension: a soil without cohesion carries none, one with cohesion up to the apex") {
    const double gradient[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const double c : {0.0, 3e3}) {
      const Constants m = soil(25 * degree, c, 0);
      Point p = Point::isotropic(100);
      p.walk(gradient, 0.01, 200, m);
      CHECK(p.first() == doctest::Approx(c > 0 ? m.strength / m.friction : 0).epsilon(1e-12));
      CHECK(p.root() <= 1e-10);
      CHECK(p.work >= 0);
    }
  }

  TEST_CASE("a rigid rotation keeps the invariants to rounding and turns the stress") {
    const Constants m = soil(30 * degree, 1e6, 0);
    const double turns = 10, omega = 2 * std::numbers::pi;
    Point p;
    const double start[6] = {-5e4, -2e4, -1e4, 3e3, -2e3, 8e3};
    std::copy(std::begin(start), std::end(start), p.stress);
    const double i1 = p.first(), root = p.root();
    const double gradient[3][3] = {{0, 0, omega}, {0, 0, 0}, {-omega, 0, 0}};  // about y
    p.walk(gradient, turns, 100000, m);
    CHECK(p.first() == doctest::Approx(i1).epsilon(1e-9));
    CHECK(p.root() == doctest::Approx(root).epsilon(1e-9));
    for (int k = 0; k < 6; ++k)
      CHECK(p.stress[k] == doctest::Approx(start[k]).epsilon(1e-5).scale(1e4));
    CHECK(p.strain == 0);
    // A quarter turn about y takes x to -z.
    Point quarter;
    std::copy(std::begin(start), std::end(start), quarter.stress);
    quarter.walk(gradient, 0.25, 20000, m);
    CHECK(quarter.stress[0] == doctest::Approx(start[2]).epsilon(1e-6));
    CHECK(quarter.stress[2] == doctest::Approx(start[0]).epsilon(1e-6));
    CHECK(quarter.stress[5] == doctest::Approx(-start[5]).epsilon(1e-6));
  }

  TEST_CASE("lanes give what single numbers give") {
    using L = Lanes<double>;
    const Constants m = soil(30 * degree, 2e3, 10 * degree);
    const DruckerPrager<L> wide{L(m.bulk),     L(m.shear),    L(m.friction),
                                L(m.dilation), L(m.strength), L(m.apex)};
    L stress[6], gradient[3][3];
    Point points[L::width];
    double slopes[L::width][3][3];
    int seed = 900;
    for (int lane = 0; lane < L::width; ++lane) {
      for (int k = 0; k < 6; ++k)
        stress[k].raw[lane] = points[lane].stress[k] = (k < 3 ? -3e4 : 0) + 2e4 * random(++seed);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          gradient[a][b].raw[lane] = slopes[lane][a][b] = lane == 0 ? 0 : random(++seed);
    }
    const PlasticStep<L> plastic = update_stress(stress, gradient, L(1e-3), wide);
    for (int lane = 0; lane < L::width; ++lane) {
      points[lane].step(slopes[lane], 1e-3, m);
      for (int k = 0; k < 6; ++k)
        CHECK(stress[k][lane] == doctest::Approx(points[lane].stress[k]).epsilon(1e-13));
      CHECK(plastic.work[lane] == doctest::Approx(points[lane].work).epsilon(1e-12));
      CHECK(plastic.strain[lane] == doctest::Approx(points[lane].strain).epsilon(1e-12));
    }
  }

}  // TEST_SUITE
