#include "sph/kernel.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/types.h"
#include "sph/lane_vec.h"

using namespace sphgeo;

namespace {

// Sums of W V, gradient of W V and r (x) gradient of W V over a lattice with h = 1.3 dp.
template <int Dim>
void check_lattice(double tolerance) {
  const double dp = 0.02;
  const Kernel<Dim> kernel(1.3 * dp);
  const double volume = std::pow(dp, Dim);
  const int reach = 3;
  double unity = 0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> moment = Eigen::Matrix<double, Dim, Dim>::Zero();
  int cell[3] = {0, 0, 0};
  for (cell[2] = Dim > 2 ? -reach : 0; cell[2] <= (Dim > 2 ? reach : 0); ++cell[2])
    for (cell[1] = Dim > 1 ? -reach : 0; cell[1] <= (Dim > 1 ? reach : 0); ++cell[1])
      for (cell[0] = -reach; cell[0] <= reach; ++cell[0]) {
        Vec<Dim> r;
        for (int d = 0; d < Dim; ++d) r[d] = dp * cell[d];
        const double r2 = r.squaredNorm();
        unity += kernel.w(r2) * volume;
        gradient += kernel.dw_over_r(r2) * volume * r;
        moment += kernel.dw_over_r(r2) * volume * r * r.transpose();
      }
  CHECK(unity == doctest::Approx(1.0).epsilon(tolerance));
  CHECK(gradient.norm() * dp < 1e-14);
  CHECK((moment + decltype(moment)::Identity()).norm() < 0.04);  // the error of 1.3 spacings
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("the kernel sums to one on a lattice and its gradient to zero") {
    check_lattice<1>(0.01);
    check_lattice<2>(0.01);
    check_lattice<3>(0.02);
  }

  TEST_CASE("the kernel integrates to one") {
    const int n = 20000;
    double one = 0, two = 0, three = 0;
    const double h = 0.7, dr = 2 * h / n, pi = std::numbers::pi;
    for (int k = 0; k < n; ++k) {
      const double r = (k + 0.5) * dr;
      one += 2 * Kernel<1>(h).w(r * r) * dr;
      two += 2 * pi * r * Kernel<2>(h).w(r * r) * dr;
      three += 4 * pi * r * r * Kernel<3>(h).w(r * r) * dr;
    }
    CHECK(one == doctest::Approx(1.0).epsilon(1e-8));
    CHECK(two == doctest::Approx(1.0).epsilon(1e-8));
    CHECK(three == doctest::Approx(1.0).epsilon(1e-8));
  }

  TEST_CASE("the derivative is that of the kernel, and finite at zero distance") {
    const Kernel<3> kernel(0.05);
    const double eps = 1e-7;
    for (const double r : {0.003, 0.02, 0.05, 0.08, 0.0999}) {
      const double below = kernel.w((r - eps) * (r - eps)), above = kernel.w((r + eps) * (r + eps));
      CHECK(kernel.dw(r * r) == doctest::Approx((above - below) / (2 * eps)).epsilon(1e-4));
      CHECK(kernel.dw_over_r(r * r) == doctest::Approx(kernel.dw(r * r) / r).epsilon(1e-12));
    }
    CHECK(kernel.w(0.0) == doctest::Approx(kernel.factor));
    CHECK(kernel.dw_over_r(0.0) == doctest::Approx(-5 * kernel.factor / (0.05 * 0.05)));
    CHECK(kernel.dw(0.0) == 0.0);
    for (const double r : {kernel.support() * (1 + 1e-12), 0.2, 1e3}) {
      CHECK(kernel.w(r * r) == 0.0);
      CHECK(kernel.dw_over_r(r * r) == 0.0);
    }
  }

  TEST_CASE("a NaN distance gives a NaN kernel") {
    const Kernel<2> kernel(0.05);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(kernel.w(nan)));
    CHECK(std::isnan(kernel.dw_over_r(nan)));
    CHECK(std::isnan(kernel.dw_over_r(Lanes<float>(nan))[0]));
    CHECK(std::isnan(kernel.dw_over_r(Lanes<double>(nan))[0]));
  }

  TEST_CASE("lanes compute what plain numbers do") {
    const Kernel<3> kernel(0.05);
    for (int k = 0; k <= 120; ++k) {
      const double r2 = 1e-4 * k;
      const double w = kernel.w(r2), d = kernel.dw_over_r(r2);
      CHECK(kernel.w(Lanes<double>(r2))[1] ==
            doctest::Approx(w).epsilon(1e-14).scale(kernel.factor));
      CHECK(kernel.dw_over_r(Lanes<double>(r2))[0] ==
            doctest::Approx(d).epsilon(1e-14).scale(-kernel.slope));
      CHECK(kernel.w(Lanes<float>(r2))[2] == doctest::Approx(w).epsilon(1e-6).scale(kernel.factor));
      CHECK(kernel.dw_over_r(Lanes<float>(r2))[3] ==
            doctest::Approx(d).epsilon(1e-6).scale(-kernel.slope));
    }
  }
}
