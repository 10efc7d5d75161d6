// Kernel sums with a smoothing length of each target's own: against all pairs in plain double.

#include "sph/variable_sums.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/hash.h"
#include "core/parallel.h"
#include "sph/kernel.h"

using namespace sphgeo;

namespace {

template <int Dim>
struct Cloud {
  std::vector<Vec<Dim>> r;
  std::vector<double> volume, h;
  std::vector<Index> targets;
  FixedPoint<Dim> frame;

  /// A jittered lattice in the unit box whose spacing grows along x; every fifth particle is fixed.
  explicit Cloud(int edge) {
    const double dp = 1.0 / edge;
    const int n = Dim == 2 ? edge * edge : edge * edge * edge;
    for (int k = 0; k < n; ++k) {
      Vec<Dim> p;
      for (int d = 0, rest = k; d < Dim; ++d, rest /= edge)
        p[d] = dp * (rest % edge + 0.5 + 0.6 * (draw() - 0.5));
      r.push_back(p);
      volume.push_back(std::pow(dp, Dim) * (1 + p[0]));
      h.push_back(1.3 * dp * (1 + p[0]));
      if (k % 5 != 0) targets.push_back(k);
    }
    frame = FixedPoint<Dim>::fit(Vec<Dim>::Constant(-1), Vec<Dim>::Constant(2), 6 * dp);
  }

  double draw() { return random_uniform(11, drawn++); }
  void move(double most) {
    for (const Index i : targets)
      for (int d = 0; d < Dim; ++d) r[static_cast<std::size_t>(i)][d] += most * (draw() - 0.5);
  }
  std::uint64_t drawn = 0;
};

template <int Dim>
void check_sums(const Cloud<Dim>& c, const std::vector<double>& density,
                const std::vector<Vec<Dim>>& gradient) {
  for (const Index t : c.targets) {
    const auto i = static_cast<std::size_t>(t);
    const Kernel<Dim> kernel(c.h[i]);
    double sum = 0;
    Vec<Dim> slope = Vec<Dim>::Zero();
    for (std::size_t j = 0; j < c.r.size(); ++j) {
      const Vec<Dim> apart = c.r[i] - c.r[j];
      sum += kernel.w(apart.squaredNorm()) * c.volume[j];
      slope += kernel.dw_over_r(apart.squaredNorm()) * c.volume[j] * apart;
    }
    CHECK(density[i] == doctest::Approx(sum).epsilon(2e-6));
    CHECK((gradient[i] - slope).norm() * c.h[i] < 5e-6);
  }
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE_TEMPLATE("variable sums: all pairs, while lists are kept", D,
                     std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
    constexpr int dim = D::value;
    const int edge = dim == 2 ? 30 : 11;
    Cloud<dim> c(edge);
    std::vector<double> density(c.r.size(), 7);
    std::vector<Vec<dim>> gradient(c.r.size(), Vec<dim>::Zero());
    VariableSums<dim> sums(c.frame, static_cast<Index>(c.r.size()), c.targets);
    for (int step = 0; step < 12; ++step) {
      sums.compute(c.r, c.volume, c.h, density, gradient);
      check_sums(c, density, gradient);
      c.move(step < 3 ? 0.1 / edge : 0.01 / edge);
    }
    CHECK(sums.searches() >= 1);
    CHECK(sums.searches() <= 6);
    CHECK(density[0] == 7);  // no target

    // A kernel that has grown past its list, and a particle from far away.
    const Index before = sums.searches();
    for (double& h : c.h) h *= 1.5;
    sums.compute(c.r, c.volume, c.h, density, gradient);
    check_sums(c, density, gradient);
    c.r[static_cast<std::size_t>(c.targets.front())] =
        c.r[static_cast<std::size_t>(c.targets.back())] + Vec<dim>::Constant(0.1 / edge);
    sums.compute(c.r, c.volume, c.h, density, gradient);
    check_sums(c, density, gradient);
    CHECK(sums.searches() == before + 2);
  }

  TEST_CASE("variable sums: the same bits for one, two and three threads") {
    const int before = threads();
    std::vector<double> first;
    for (const int n : {1, 2, 3}) {
      set_threads(n);
      Cloud<2> c(40);
      std::vector<double> density(c.r.size(), 0);
      std::vector<Vec<2>> gradient(c.r.size(), Vec<2>::Zero());
      VariableSums<2> sums(c.frame, static_cast<Index>(c.r.size()), c.targets);
      for (int step = 0; step < 4; ++step) {
        sums.compute(c.r, c.volume, c.h, density, gradient);
        for (const Index i : c.targets)
          c.r[static_cast<std::size_t>(i)] -= 1e-4 * gradient[static_cast<std::size_t>(i)];
      }
      if (first.empty()) first = density;
      CHECK(first == density);
    }
    set_threads(before);
  }
}
