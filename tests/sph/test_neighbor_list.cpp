#include "sph/neighbor_list.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"

using namespace sphgeo;

namespace {

using Pairs = std::set<std::pair<Index, Index>>;

template <int Dim>
std::vector<Vec<Dim>> random_points(Index n, double size, std::uint64_t seed) {
  std::vector<Vec<Dim>> r(static_cast<std::size_t>(n));
  std::uint64_t k = 0;
  for (auto& p : r)
    for (int d = 0; d < Dim; ++d) p[d] = size * random_uniform(seed, k++);
  return r;
}

template <int Dim>
FixedPoint<Dim> unit_frame(double support) {
  return FixedPoint<Dim>::fit(Vec<Dim>::Zero(), Vec<Dim>::Ones(), support);
}

// Reports a pair as missing or wrong only if it is not at the very rim, where rounding decides.
template <int Dim>
void check_pairs(const NeighborList& list, const std::vector<Vec<Dim>>& targets,
                 const std::vector<Vec<Dim>>& sources, double radius, Pairing pairing) {
  Pairs found;
  list.for_each_pair([&](Index i, Index j) { CHECK(found.insert({i, j}).second); });
  CHECK(static_cast<Index>(found.size()) == list.pairs());
  Index wrong = 0;
  for (Index i = 0; i < static_cast<Index>(targets.size()); ++i)
    for (Index j = 0; j < static_cast<Index>(sources.size()); ++j) {
      const double distance =
          (targets[static_cast<std::size_t>(i)] - sources[static_cast<std::size_t>(j)]).norm();
      const bool self = pairing == Pairing::within && i == j;
      const bool listed = found.count({i, j}) > 0;
      if (self || distance > radius * (1 + 2e-6)) wrong += listed;
      else if (distance < radius * (1 - 2e-6)) wrong += !listed;
    }
  CHECK(wrong == 0);
}

template <int Dim>
void check_random(Index n, double radius, double grid_reach) {
  const auto r = random_points<Dim>(n, 1.0, 3);
  CellGrid<Dim> grid;
  grid.build(r, unit_frame<Dim>(grid_reach), grid_reach);
  NeighborList list;
  list.build<Dim>(r, grid, radius, Pairing::within);
  CHECK(list.active() == n);
  check_pairs<Dim>(list, r, r, radius, Pairing::within);

  // Sorted: the same pairs by other names, and sorting again changes nothing.
  std::vector<Vec<Dim>> sorted;
  for (const std::uint32_t i : grid.order()) sorted.push_back(r[i]);
  grid.set_sorted();
  const Index pairs = list.pairs();
  list.build<Dim>(sorted, grid, radius, Pairing::within);
  CHECK(list.pairs() == pairs);
  check_pairs<Dim>(list, sorted, sorted, radius, Pairing::within);
  grid.build(sorted, unit_frame<Dim>(grid_reach), grid_reach);
  CHECK(std::is_sorted(grid.order().begin(), grid.order().end()));
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("lists of one set hold exactly the pairs in reach") {
    check_random<2>(1500, 0.06, 0.06);
    check_random<3>(1500, 0.15, 0.15);
    check_random<1>(300, 0.02, 0.02);
    check_random<2>(700, 0.05, 0.11);  // searched with less than the grid was made for
    check_random<3>(700, 0.3, 0.1);    // and with more
    check_random<3>(40, 2.0, 2.0);     // everyone sees everyone
  }

  TEST_CASE("tiny and empty sets") {
    const auto frame = unit_frame<3>(0.1);
    CellGrid<3> none, one;
    const std::vector<Vec<3>> nobody, single{Vec<3>::Constant(0.5)};
    none.build(nobody, frame, 0.1);
    one.build(single, frame, 0.1);
    NeighborList list;
    list.build<3>(nobody, none, 0.1, Pairing::within);
    CHECK(list.pairs() == 0);
    CHECK(list.blocks().empty());
    list.build<3>(single, none, 0.1, Pairing::across);
    CHECK(list.active() == 0);
    list.build<3>(nobody, one, 0.1, Pairing::across);
    CHECK(list.active() == 0);
    list.build<3>(single, one, 0.1, Pairing::within);
    CHECK(list.active() == 1);
    CHECK(list.pairs() == 0);
    list.build<3>(single, one, 0.1, Pairing::across);
    CHECK(list.pairs() == 1);
    // Lists may be used again for smaller sets.
    list.build<3>(nobody, none, 0.1, Pairing::within);
    CHECK(list.blocks().empty());
  }

  TEST_CASE("lists between two sets walk only targets with neighbors, and agree both ways") {
    const double radius = 0.07;
    auto a = random_points<2>(900, 1.0, 8), b = random_points<2>(500, 1.0, 9);
    for (auto& p : b) p[0] = 0.3 * p[0] - 0.1;  // some outside the box of a, much of a alone
    CellGrid<2> grid_a, grid_b;
    grid_a.build(a, unit_frame<2>(radius), radius);
    grid_b.build(b, unit_frame<2>(radius), radius);
    NeighborList ab, ba;
    ab.build<2>(a, grid_b, radius, Pairing::across);
    ba.build<2>(b, grid_a, radius, Pairing::across);
    check_pairs<2>(ab, a, b, radius, Pairing::across);
    check_pairs<2>(ba, b, a, radius, Pairing::across);
    Pairs forth, back;
    std::set<Index> with_neighbor;
    ab.for_each_pair([&](Index i, Index j) {
      forth.insert({i, j});
      with_neighbor.insert(i);
    });
    ba.for_each_pair([&](Index i, Index j) { back.insert({j, i}); });
    CHECK(forth == back);
    CHECK(ab.active() == static_cast<Index>(with_neighbor.size()));
    CHECK(ab.active() < 600);
    CHECK(ab.active() > 100);
  }

  TEST_CASE("pairs at the rim are seen by both or by none") {
    // A lattice with the radius equal to a multiple of the spacing, in two frames of reference.
    const double dp = 0.01, radius = 3 * dp;
    std::vector<Vec<3>> r;
    for (int z = 0; z < 9; ++z)
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) r.push_back(dp * Vec<3>(x, y, z));
    for (const double size : {0.1, 1000.0}) {
      const auto frame =
          FixedPoint<3>::fit(Vec<3>::Constant(-size), Vec<3>::Constant(size), radius);
      CellGrid<3> grid;
      grid.build(r, frame, radius);
      NeighborList list;
      list.build<3>(r, grid, radius, Pairing::within);
      Pairs forth, back;
      list.for_each_pair([&](Index i, Index j) {
        forth.insert({i, j});
        back.insert({j, i});
      });
      CHECK(forth == back);
      CHECK(forth.size() > 729 * 40);
      if (size < 1) check_pairs<3>(list, r, r, radius, Pairing::within);
    }
  }

  TEST_CASE("neighbors come in cell order, lists are padded with the null record") {
    auto r = random_points<3>(2000, 1.0, 4);
    CellGrid<3> grid;
    grid.build(r, unit_frame<3>(0.2), 0.2);
    std::vector<Vec<3>> sorted;
    for (const std::uint32_t i : grid.order()) sorted.push_back(r[i]);
    grid.set_sorted();
    NeighborList list;
    list.build<3>(sorted, grid, 0.2, Pairing::within);
    for (const auto& block : list.blocks()) {
      for (std::size_t k = 0; k < block.size(); ++k) {
        const auto* e = block.entries.data() + block.begin[k];
        const std::size_t n = block.count[k];
        CHECK(std::is_sorted(e, e + n));
        CHECK(block.begin[k] % NeighborList::padding == 0);
        for (std::size_t p = n; p % NeighborList::padding != 0; ++p) CHECK(e[p] == 8 * r.size());
      }
    }
  }

  TEST_CASE("a scattered few in a huge box need few cells, and nobody is lost") {
    auto r = random_points<3>(300, 0.1, 5);
    r.push_back(Vec<3>(4000, -2000, 900));
    r.push_back(r.back() + Vec<3>::Constant(0.004));
    const auto frame = FixedPoint<3>::fit(Vec<3>::Constant(-4000), Vec<3>::Constant(4000), 0.02);
    CellGrid<3> grid;
    grid.build(r, frame, 0.02);
    CHECK(grid.bytes() < 2000000);
    NeighborList list;
    list.build<3>(r, grid, 0.02, Pairing::within);
    // Quanta are coarse in such a box: the positions that count are the rounded ones.
    std::vector<Vec<3>> rounded = r;
    for (auto& p : rounded)
      for (int d = 0; d < 3; ++d) p[d] = frame.origin[d] + frame.quantum * frame.to_fixed(p[d], d);
    check_pairs<3>(list, rounded, rounded, 0.02, Pairing::within);
    bool far_pair = false;
    list.for_each_pair([&](Index i, Index j) { far_pair |= i == 300 && j == 301; });
    CHECK(far_pair);
  }

  TEST_CASE("positions that left the frame are clamped to it, not wrapped around") {
    const auto frame = unit_frame<2>(0.1);
    CHECK(frame.to_fixed(1e30, 0) == frame.to_fixed(100.0, 0));
    CHECK(frame.to_fixed(-1e30, 1) == frame.to_fixed(std::nan(""), 1));
    CHECK(frame.to_fixed(100.0, 0) > frame.to_fixed(1.0, 0));
    CHECK(frame.to_fixed(-100.0, 0) > 0);
    CHECK(frame.quantum * frame.to_fixed(-100.0, 0) > 0.2);  // out of reach of the null record
  }

  TEST_CASE("points are found around a probe") {
    const auto r = random_points<2>(800, 1.0, 6);
    CellGrid<2> grid;
    grid.build(r, unit_frame<2>(0.05), 0.05);
    for (const Vec<2>& at : {Vec<2>(0.5, 0.5), Vec<2>(0.0, 1.0), Vec<2>(1.04, 0.3), Vec<2>(9, 9)}) {
      for (const double radius : {0.05, 0.12}) {
        std::set<Index> found, expected;
        grid.for_each_in_reach(at, radius, [&](Index j, double r2) {
          found.insert(j);
          CHECK(r2 == doctest::Approx((at - r[std::size_t(j)]).squaredNorm()).epsilon(1e-6));
        });
        for (std::size_t j = 0; j < r.size(); ++j)
          if ((at - r[j]).norm() < radius) expected.insert(static_cast<Index>(j));
        CHECK(found == expected);
      }
    }
  }

  TEST_CASE("order and lists do not depend on the number of threads") {
    const int before = threads();
    const auto r = random_points<3>(5000, 1.0, 7);
    std::vector<std::uint32_t> order;
    std::vector<std::pair<Index, Index>> pairs;
    for (const int n_threads : {1, 2, 3, 4, 7}) {
      set_threads(n_threads);
      CellGrid<3> grid;
      grid.build(r, unit_frame<3>(0.1), 0.1);
      NeighborList list;
      list.build<3>(r, grid, 0.1, Pairing::within);
      std::vector<std::pair<Index, Index>> now;
      list.for_each_pair([&](Index i, Index j) { now.emplace_back(i, j); });
      const std::vector<std::uint32_t> now_order(grid.order().begin(), grid.order().end());
      if (n_threads == 1) {
        order = now_order;
        pairs = now;
      }
      CHECK(now_order == order);
      CHECK(now == pairs);
    }
    set_threads(before);
  }
}
