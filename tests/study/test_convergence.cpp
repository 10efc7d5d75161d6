#include "study/convergence.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using sphgeo::convergence;
using sphgeo::Level;
using sphgeo::order_of_errors;

TEST_SUITE_BEGIN("study");

namespace {

/// Values f = exact + c h^p.
std::vector<Level> ladder(const std::vector<double>& spacings, double exact, double c, double p) {
  std::vector<Level> levels;
  for (const double h : spacings)
    levels.push_back({h, exact + c * std::pow(h, p), std::abs(c) * std::pow(h, p)});
  return levels;
}

}  // namespace

TEST_CASE("an exact power law gives its order, its limit and Roache's index") {
  for (const double p : {0.6, 1.0, 1.7, 2.0, 3.5})
    for (const double c : {0.3, -0.3}) {
      const auto found = convergence(ladder({0.04, 0.02, 0.01}, 5, c, p));
      CHECK(found.label == "monotone");
      CHECK(found.order_from == "values");
      CHECK(*found.order == doctest::Approx(p).epsilon(1e-6));
      CHECK(*found.extrapolated == doctest::Approx(5).epsilon(1e-9));
      const double fine = 5 + c * std::pow(0.01, p);
      CHECK(*found.gci == doctest::Approx(1.25 * std::abs(5 - fine) / fine).epsilon(1e-6));
    }
}

TEST_CASE("spacings need not have equal ratios, and only the three finest count") {
  auto levels = ladder({0.05, 0.03, 0.01}, 2, 1, 1.5);
  levels.insert(levels.begin(), Level{0.2, 17, {}});
  const auto found = convergence(levels);
  CHECK(*found.order == doctest::Approx(1.5).epsilon(1e-6));
  CHECK(*found.extrapolated == doctest::Approx(2).epsilon(1e-8));
}

TEST_CASE("the worked example of Celik et al. 2008: order 1.53, 6.1685, GCI 2.2 %") {
  // Table 1, first column: dimensionless reattachment length on 18000, 8000 and 4500 cells in two
  // dimensions.
  const double h1 = std::sqrt(1.0 / 18000), h2 = std::sqrt(1.0 / 8000), h3 = std::sqrt(1.0 / 4500);
  const auto found =
      convergence(std::vector<Level>{{h3, 5.863, {}}, {h2, 5.972, {}}, {h1, 6.063, {}}});
  CHECK(*found.order == doctest::Approx(1.53).epsilon(0.01));
  CHECK(*found.extrapolated == doctest::Approx(6.1685).epsilon(0.0005));
  CHECK(*found.gci == doctest::Approx(0.022).epsilon(0.02));
}

TEST_CASE("values that swing are called oscillatory and have half their range for uncertainty") {
  const auto found =
      convergence(std::vector<Level>{{0.04, 1.2, {}}, {0.02, 0.9, {}}, {0.01, 1.0, {}}});
  CHECK(found.label == "oscillatory");
  CHECK_FALSE(found.order);
  CHECK_FALSE(found.extrapolated);
  CHECK(*found.uncertainty == doctest::Approx(1.25 * 0.15));
}

TEST_CASE("values that drift apart are not in the asymptotic range, and nothing is extrapolated") {
  const auto found =
      convergence(std::vector<Level>{{0.04, 1.0, {}}, {0.02, 1.1, {}}, {0.01, 1.3, {}}});
  CHECK(found.label == "not in the asymptotic range");
  CHECK_FALSE(found.extrapolated);
  CHECK(*found.uncertainty == doctest::Approx(3 * 0.2));
}

TEST_CASE("two levels have the order of their errors and a threefold safety") {
  const auto found = convergence(ladder({0.02, 0.01}, 1, 1, 1));
  CHECK(found.label == "too few levels");
  CHECK(found.order_from == "errors");
  CHECK(*found.order == doctest::Approx(1));
  CHECK(*found.uncertainty == doctest::Approx(0.03));
  CHECK_FALSE(convergence(std::vector<Level>{{0.01, 1, 0.1}}).order);
}

TEST_CASE("an error of rounding takes no part in the order") {
  const std::vector<Level> exact = {{0.04, 1, 1e-15}, {0.02, 1, 2e-15}, {0.01, 1.001, 1e-3}};
  CHECK_FALSE(order_of_errors(exact));
  const std::vector<Level> mixed = {{0.04, 1, 0.04}, {0.02, 1, 0.02}, {0.01, 1.0, 1e-12}};
  CHECK(*order_of_errors(mixed) == doctest::Approx(1));
}

TEST_CASE("values equal to rounding are unchanged") {
  const auto found =
      convergence(std::vector<Level>{{0.04, 1, {}}, {0.02, 1 + 1e-15, {}}, {0.01, 1, {}}});
  CHECK(found.label == "unchanged");
  CHECK(*found.gci == 0);
}

TEST_SUITE_END();
