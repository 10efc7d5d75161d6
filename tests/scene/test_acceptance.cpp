#include "scene/acceptance.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "geometry/shapes.h"

using namespace sphgeo;

namespace {

/// A square of n cells with the same share of water in each.
std::vector<Candidate> block(int n, double water) {
  std::vector<Candidate> out;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) out.push_back({{i + 0.5, 0, k + 0.5}, water, true});
  return out;
}

/// Variance of the number of particles in squares of 8 by 8 cells.
double variance(const std::vector<Candidate>& all, const std::vector<std::size_t>& accepted,
                int n) {
  const int squares = n / 8;
  std::vector<double> count(static_cast<std::size_t>(squares * squares), 0);
  for (const std::size_t k : accepted)
    count[static_cast<std::size_t>(static_cast<int>(all[k].at.z() / 8) * squares +
                                   static_cast<int>(all[k].at.x() / 8))] += 1;
  double mean = 0, sum = 0;
  for (const double c : count) mean += c / static_cast<double>(count.size());
  for (const double c : count) sum += (c - mean) * (c - mean) / static_cast<double>(count.size());
  return sum;
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("the curve visits every cell once, from neighbor to neighbor") {
    for (const int dim : {2, 3}) {
      const int bits = 3, edge = 8;
      std::vector<std::array<int, 3>> path(
          static_cast<std::size_t>(dim == 2 ? edge * edge : edge * edge * edge), {-1, -1, -1});
      for (int k = 0; k < (dim == 3 ? edge : 1); ++k)
        for (int j = 0; j < edge; ++j)
          for (int i = 0; i < edge; ++i) {
            const std::uint32_t cell[3] = {static_cast<std::uint32_t>(i),
                                           static_cast<std::uint32_t>(j),
                                           static_cast<std::uint32_t>(k)};
            const std::uint64_t place = hilbert_index(cell, dim, bits);
            REQUIRE(place < path.size());
            CHECK(path[place][0] == -1);
            path[place] = {i, j, k};
          }
      for (std::size_t m = 1; m < path.size(); ++m) {
        int steps = 0;
        for (std::size_t a = 0; a < 3; ++a) steps += std::abs(path[m][a] - path[m - 1][a]);
        CHECK(steps == 1);
      }
    }
  }

  TEST_CASE("the total is exact for every share, and nothing is taken twice") {
    for (const double water : {0.05, 0.31, 0.5, 0.77, 0.999}) {
      const std::vector<Candidate> all = block(40, water);
      for (const Acceptance kind : {Acceptance::stratified, Acceptance::independent})
        for (const std::uint64_t seed : {1u, 2u, 3u}) {
          const std::vector<std::size_t> taken = accept(all, kind, seed, 1, 2);
          CHECK(static_cast<long>(taken.size()) == std::lround(water_volume(all)));
          CHECK(std::set<std::size_t>(taken.begin(), taken.end()).size() == taken.size());
          CHECK(accept(all, kind, seed, 1, 2) == taken);
          CHECK(accept(all, kind, seed + 10, 1, 2) != taken);
        }
    }
    // Whole cells are always taken.
    std::vector<Candidate> mixed = block(10, 0.5);
    for (std::size_t k = 0; k < 30; ++k) mixed[k].water = 1;
    const std::vector<std::size_t> taken = accept(mixed, Acceptance::stratified, 1, 1, 2);
    CHECK(taken.size() == 65);
    for (std::size_t k = 0; k < 30; ++k) CHECK(taken[k] == k);
  }

  TEST_CASE("stratified draws share the water out evenly, independent ones as dice do") {
    const std::vector<Candidate> all = block(64, 0.5);
    const double stratified = variance(all, accept(all, Acceptance::stratified, 1, 1, 2), 64);
    const double independent = variance(all, accept(all, Acceptance::independent, 1, 1, 2), 64);
    CHECK(stratified < 1);
    CHECK(independent > 8);  // binomial: 16
    CHECK(independent < 28);
  }

  TEST_CASE("a cut cell holds what lies on this side of the cut") {
    Model model;
    Box box;
    box.max = {0.95, 1, 0.73};
    box.flat = true;
    const WaterTarget clear(model);
    CHECK(water_volume(candidates(box, clear, 0.1, 2, 0.5)) ==
          doctest::Approx(0.95 * 0.73 / 0.01).epsilon(1e-9));
    Sphere disc;
    disc.center = {0.3, 0, 0.2};
    disc.radius = 1;
    disc.flat = true;
    CHECK(water_volume(candidates(disc, clear, 0.1, 2, 0.5)) ==
          doctest::Approx(M_PI / 0.01).epsilon(2e-4));
    Sphere ball;
    ball.radius = 1;
    CHECK(water_volume(candidates(ball, clear, 0.1, 3, 0.5)) ==
          doctest::Approx(4 * M_PI / 3 / 0.001).epsilon(1e-3));
  }
}
