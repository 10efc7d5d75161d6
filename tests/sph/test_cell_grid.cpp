#include "sph/cell_grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"

using namespace sphgeo;

namespace {

constexpr double search_reach = 0.1;

template <int Dim>
FixedPoint<Dim> frame_of_size(double size) {
  return FixedPoint<Dim>::fit(Vec<Dim>::Zero(), Vec<Dim>::Constant(size), search_reach);
}

template <int Dim>
struct Particles {
  std::vector<Vec<Dim>> r;
  std::vector<Id> id;

  void add(const Vec<Dim>& at, Id name) {
    r.push_back(at);
    id.push_back(name);
  }
  // Ids in the order of the grid.
  std::vector<Id> sorted(const FixedPoint<Dim>& frame) const {
    CellGrid<Dim> grid;
    grid.build(r, frame, search_reach, id);
    std::vector<Id> ids;
    for (const std::uint32_t i : grid.order()) ids.push_back(id[i]);
    return ids;
  }
  // The same ones in another order.
  Particles shuffled(std::uint64_t seed) const {
    std::vector<std::size_t> order(r.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return random_uniform(seed, a) < random_uniform(seed, b);
    });
    Particles other;
    for (const std::size_t i : order) other.add(r[i], id[i]);
    return other;
  }
};

// Ids that do not rise with anything.
template <int Dim>
Particles<Dim> cloud(Index n, double size, std::uint64_t seed) {
  Particles<Dim> p;
  for (Index i = 0; i < n; ++i) {
    Vec<Dim> at;
    for (int d = 0; d < Dim; ++d)
      at[d] = size * random_uniform(seed, static_cast<std::uint64_t>(Dim * i + d));
    p.add(at, static_cast<Id>((i * 7919) % n + 100));
  }
  return p;
}

template <int Dim>
void check_order_is_of_particles_alone(Index n, double size) {
  const Particles<Dim> all = cloud<Dim>(n, size, 5);
  const auto frame = frame_of_size<Dim>(4 * size);
  const std::vector<Id> order = all.sorted(frame);
  CHECK(all.shuffled(1).sorted(frame) == order);
  CHECK(all.shuffled(2).sorted(frame) == order);

  // A part of them, in a box of its own, and in one that somebody far away makes larger.
  Particles<Dim> part;
  std::set<Id> in_part;
  for (std::size_t i = 0; i < all.r.size(); ++i)
    if ((all.r[i].array() > 0.31 * size).all() && all.r[i].x() < 0.77 * size) {
      part.add(all.r[i], all.id[i]);
      in_part.insert(all.id[i]);
    }
  std::vector<Id> expected;
  std::copy_if(order.begin(), order.end(), std::back_inserter(expected),
               [&](Id id) { return in_part.contains(id); });
  REQUIRE(expected.size() > 20);
  CHECK(part.sorted(frame) == expected);
  part.add(Vec<Dim>::Constant(3.9 * size), 1);
  expected.push_back(1);
  CHECK(part.sorted(frame) == expected);

  for (const int n_threads : {1, 2, 5}) {
    set_threads(n_threads);
    CHECK(all.sorted(frame) == order);
    CHECK(part.sorted(frame) == expected);
  }
  set_threads(2);
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("order of particles depends on their cells and ids alone") {
    check_order_is_of_particles_alone<1>(4000, 3.0);
    check_order_is_of_particles_alone<2>(30000, 4.0);
    check_order_is_of_particles_alone<3>(30000, 2.0);
    check_order_is_of_particles_alone<3>(3000, 500.0);  // mostly empty cells
    check_order_is_of_particles_alone<3>(40000, 0.05);  // all in one cell
  }

  TEST_CASE("without ids particles of a cell stand in the order of indices") {
    std::vector<Vec<2>> r(1000, Vec<2>(0.501, 0.502));
    CellGrid<2> grid;
    grid.build(r, frame_of_size<2>(1.0), search_reach);
    CHECK(std::is_sorted(grid.order().begin(), grid.order().end()));
  }

  // Two dense clouds at opposite corners of a domain of 10^15 cells, and some between them.
  TEST_CASE("few particles in a huge domain need little memory and few candidates") {
    constexpr double size = 9000;
    constexpr Index n = 20000;
    Particles<3> p = cloud<3>(n, 1.0, 8);
    for (Index i = 0; i < n; ++i) {
      Vec<3>& at = p.r[static_cast<std::size_t>(i)];
      if (i % 2 == 0) at += Vec<3>::Constant(size - 2);
      if (i % 100 == 1) at *= 0.9 * size;
    }
    const auto frame = frame_of_size<3>(size);
    CHECK(p.shuffled(1).sorted(frame) == p.sorted(frame));
    CellGrid<3> grid;
    grid.build(p.r, frame, search_reach, p.id);
    CHECK(grid.bytes() < 100 * static_cast<std::size_t>(n));

    // Rows of cells hold no more than the box that they are asked for, and a cell around it.
    Index most = 0, found = 0;
    for (std::size_t i = 0; i < p.r.size(); i += 97) {
      std::int32_t x[3];
      for (int d = 0; d < 3; ++d) x[d] = frame.to_fixed(p.r[i][d], d);
      Index candidates = 0;
      grid.for_each_row(x, x, search_reach * frame.per_quantum,
                        [&](std::size_t begin, std::size_t end) {
                          candidates += static_cast<Index>(end - begin);
                        });
      most = std::max(most, candidates);
      Index near = 0, true_near = 0;
      grid.for_each_in_reach(p.r[i], search_reach, [&](Index, double) { ++near; });
      for (const Vec<3>& at : p.r) true_near += (at - p.r[i]).norm() < search_reach;
      CHECK(std::abs(near - true_near) <= 1);  // one may be at the very rim
      found += near;
    }
    CHECK(found > 5000);
    CHECK(most < 10000 * 0.4 * 0.4 * 0.4);
  }
}
