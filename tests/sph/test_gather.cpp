#include "sph/gather.h"

#include <doctest/doctest.h>

#include <cstring>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "sph/kernel.h"

using namespace sphgeo;

namespace {

template <int Dim>
struct Fluid : RecordType<Dim> {
  static constexpr RecordField<Fluid, Dim> V{};
  static constexpr RecordField<Fluid, Dim + 1, Dim> v{};
  static constexpr RecordField<Fluid, 2 * Dim + 1> p{};
  static constexpr RecordSpec spec{"fluid", 0, "", {{{"V", V}, {"v", v}, {"p", p}}}};
};
template <int Dim>
struct Extra : RecordType<Dim> {
  static constexpr RecordField<Extra, 7> factor{};
  static constexpr RecordSpec spec{"extra", 1, "", {{{"factor", factor}}}};
};

// A pair function with everything the real ones have; fields of a record, and one of a second.
template <int Dim>
struct Mixed {
  Kernel<Dim> kernel;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
    T rate{};
  };
  template <class T, class... R>
  void operator()(Sums<T>& sum, const Record<T, R...>& i, const Record<T, R...>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    constexpr auto V = Fluid<Dim>::V;
    constexpr auto v = Fluid<Dim>::v;
    constexpr auto p = Fluid<Dim>::p;
    const T dW_r = kernel.dw_over_r(r2) * j[V];
    const LaneVec<Dim, T> v_ij = i.vec(v) - j.vec(v);
    const T closing = max(T(0), -dot(v_ij, r) * inverse_length(r2));
    T pressure = i[p] + j[p] + T(3) * closing;
    if constexpr (sizeof...(R) == 2) pressure += i[Extra<Dim>::factor] * j[Extra<Dim>::factor];
    sum.force += v_ij * (dW_r * r2 * reciprocal(r2 + T(0.01))) - (pressure * dW_r) * r;
    sum.rate += kernel.w(r2) * j[V] + select(closing > T(0), dW_r, -dW_r);
  }
};

// A jittered block of water and a wall of coarser particles below it.
template <int Dim>
struct Scene {
  double dp = 0.05, h = 1.3 * dp;
  FixedPoint<Dim> frame;
  std::vector<Vec<Dim>> water, wall;
  CellGrid<Dim> water_grid, wall_grid;
  NeighborList within, across;

  explicit Scene(double where = 0.0, double box = 1.0) {
    const int edge = Dim == 2 ? 24 : 9;
    std::uint64_t k = 0;
    const Vec<Dim> corner = Vec<Dim>::Constant(where);
    for (int c = 0; c < std::pow(edge, Dim); ++c) {
      Vec<Dim> at;
      for (int d = 0, rest = c; d < Dim; ++d, rest /= edge)
        at[d] = dp * (rest % edge + 0.4 * random_uniform(11, k++));
      water.push_back(corner + at);
      at[Dim - 1] -= dp * edge;
      if (at[Dim - 1] > -4 * dp) wall.push_back(corner + at);
    }
    frame = FixedPoint<Dim>::fit(corner - Vec<Dim>::Constant(box), corner + Vec<Dim>::Constant(box),
                                 2 * h);
    const auto sort = [&](auto& r, auto& grid) {
      grid.build(r, frame, 2 * h);
      std::vector<Vec<Dim>> sorted;
      for (const std::uint32_t i : grid.order()) sorted.push_back(r[i]);
      grid.set_sorted();
      r = sorted;
    };
    sort(water, water_grid);
    sort(wall, wall_grid);
    within.build<Dim>(water, water_grid, 2 * h, Pairing::within);
    across.build<Dim>(water, wall_grid, 2 * h, Pairing::across);
  }

  // The same numbers in both precisions: positions on the quanta, the rest floats.
  template <class T>
  Records<Dim, T> records(const std::vector<Vec<Dim>>& r, std::uint64_t seed) const {
    Records<Dim, T> a(static_cast<Index>(r.size()), frame);
    for (Index i = 0; i < a.size(); ++i) {
      Vec<Dim> at = r[static_cast<std::size_t>(i)];
      for (int d = 0; d < Dim; ++d)
        at[d] = frame.origin[d] + frame.quantum * frame.to_fixed(at[d], d);
      a.set_position(i, at);
      for (int k = Dim; k < record_size; ++k) {
        const auto n = static_cast<std::uint64_t>(record_size * i + k);
        a[i][k] = static_cast<T>(static_cast<float>(random_uniform(seed, n) - 0.5));
      }
      a[i][Dim] = static_cast<T>(static_cast<float>(std::pow(dp, Dim)));
    }
    return a;
  }
};

template <int Dim>
using SumOf = typename Mixed<Dim>::template Sums<double>;

// The numbers as those of a record type.
template <template <int> class R = Fluid, int Dim, class T>
RecordSource<R<Dim>, T> as(const Records<Dim, T>& records) {
  return RecordSource<R<Dim>, T>(records);
}

// Largest difference of two results relative to their largest value.
template <int Dim>
double difference(const std::vector<SumOf<Dim>>& a, const std::vector<SumOf<Dim>>& b) {
  double off = 0, off_rate = 0, size = 1e-300, size_rate = 1e-300;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      off = std::max(off, std::fabs(a[i].force[d] - b[i].force[d]));
      size = std::max(size, std::fabs(b[i].force[d]));
    }
    off_rate = std::max(off_rate, std::fabs(a[i].rate - b[i].rate));
    size_rate = std::max(size_rate, std::fabs(b[i].rate));
  }
  return std::max(off / size, off_rate / size_rate);
}

template <int Dim, class T>
void check_against_brute_force(double tolerance, double where, double box) {
  const Scene<Dim> scene(where, box);
  const Mixed<Dim> pair{Kernel<Dim>(scene.h)};
  const std::size_t n = scene.water.size();
  std::vector<SumOf<Dim>> fast(n), slow(n), fast_wall(n), slow_wall(n), fast_two(n), slow_two(n);
  const auto into = [](auto& to) {
    return [&to](Index i, const SumOf<Dim>& s) { to[static_cast<std::size_t>(i)] = s; };
  };
  {
    const auto water = scene.template records<T>(scene.water, 1);
    const auto wall = scene.template records<T>(scene.wall, 2);
    const auto water2 = scene.template records<T>(scene.water, 3);
    gather<Mixed<Dim>::template Sums>(scene.within, as(water), as(water), pair, into(fast));
    gather<Mixed<Dim>::template Sums>(scene.across, as(water), as(wall), pair, into(fast_wall));
    const auto both = with<T>(as(water), as<Extra>(water2));
    gather<Mixed<Dim>::template Sums>(scene.within, both, both, pair, into(fast_two));
  }
  const auto water = scene.template records<double>(scene.water, 1);
  const auto wall = scene.template records<double>(scene.wall, 2);
  const auto water2 = scene.template records<double>(scene.water, 3);
  const double reach = 2 * scene.h;
  brute_force<Mixed<Dim>::template Sums>(as(water), as(water), reach, Pairing::within, pair,
                                         into(slow));
  brute_force<Mixed<Dim>::template Sums>(as(water), as(wall), reach, Pairing::across, pair,
                                         into(slow_wall));
  const auto both = with<double>(as(water), as<Extra>(water2));
  brute_force<Mixed<Dim>::template Sums>(both, both, reach, Pairing::within, pair, into(slow_two));
  CHECK(difference<Dim>(fast, slow) < tolerance);
  CHECK(difference<Dim>(fast_wall, slow_wall) < tolerance);
  CHECK(difference<Dim>(fast_two, slow_two) < tolerance);
  CHECK(difference<Dim>(fast_two, slow) > 1e-3);  // the second record counts
}

// All results of passes in both precisions, as bytes.
std::vector<double> all_results(const Scene<3>& scene) {
  const Mixed<3> pair{Kernel<3>(scene.h)};
  std::vector<double> out(scene.water.size() * 12, 0.0);
  const auto pass = [&](auto number, const NeighborList& list, const auto& sources,
                        std::size_t at) {
    using T = decltype(number);
    const auto a = scene.records<T>(scene.water, 1), b = scene.records<T>(sources, 2);
    gather<Mixed<3>::Sums>(list, as(a), as(b), pair, [&](Index i, const SumOf<3>& s) {
      std::memcpy(&out[static_cast<std::size_t>(i) * 12 + at], &s, 4 * sizeof(double));
    });
  };
  pass(1.0f, scene.within, scene.water, 0);
  pass(1.0, scene.within, scene.water, 4);
  pass(1.0f, scene.across, scene.wall, 8);
  return out;
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("gather in double precision equals all pairs by brute force") {
    check_against_brute_force<2, double>(1e-13, 0.0, 1.0);
    check_against_brute_force<3, double>(1e-13, 0.0, 1.0);
  }

  TEST_CASE("gather in single precision equals brute force to single precision") {
    check_against_brute_force<2, float>(2e-6, 0.0, 1.0);
    check_against_brute_force<3, float>(2e-6, 0.0, 1.0);
  }

  TEST_CASE("single precision is as good far from the origin of a large domain") {
    check_against_brute_force<3, float>(2e-6, 1234.5, 2000.0);
  }

  TEST_CASE("coinciding particles give finite sums") {
    const std::vector<Vec<3>> r(5, Vec<3>::Constant(0.25));
    const auto frame = FixedPoint<3>::fit(Vec<3>::Zero(), Vec<3>::Ones(), 0.2);
    CellGrid<3> grid;
    grid.build(r, frame, 0.2);
    NeighborList list;
    list.build<3>(r, grid, 0.2, Pairing::within);
    CHECK(list.pairs() == 20);
    Records<3, float> a(5, frame);
    for (Index i = 0; i < 5; ++i) {
      a.set_position(i, r[static_cast<std::size_t>(i)]);
      for (int k = 3; k < 8; ++k) a[i][k] = 1.0f;
    }
    gather<Mixed<3>::Sums>(list, as(a), as(a), Mixed<3>{Kernel<3>(0.1)}, [&](Index, const auto& s) {
      for (int d = 0; d < 3; ++d) CHECK(s.force[d] == 0.0);
      CHECK(std::isfinite(s.rate));
    });
  }

  TEST_CASE("forces of a pair are opposite, so momentum is conserved to round-off") {
    const Scene<3> scene;
    const auto a = scene.records<double>(scene.water, 1);
    const auto b = scene.records<float>(scene.water, 1);
    Vec3 total = Vec3::Zero(), total_float = Vec3::Zero();
    double size = 0;
    const Mixed<3> pair{Kernel<3>(scene.h)};
    set_threads(1);
    gather<Mixed<3>::Sums>(scene.within, as(a), as(a), pair, [&](Index, const SumOf<3>& s) {
      const Vec3 f(s.force[0], s.force[1], s.force[2]);
      total += f;
      size += f.norm();
    });
    gather<Mixed<3>::Sums>(scene.within, as(b), as(b), pair, [&](Index, const SumOf<3>& s) {
      total_float += Vec3(s.force[0], s.force[1], s.force[2]);
    });
    CHECK(size > 1.0);
    CHECK(total.norm() < 1e-14 * size);
    CHECK(total_float.norm() < 1e-6 * size);
  }

  TEST_CASE("the bits do not depend on the number of threads") {
    const int before = threads();
    set_threads(1);
    const Scene<3> scene;
    const std::vector<double> one = all_results(scene);
    for (const int n : {2, 3, 4, 7}) {
      set_threads(n);
      const std::vector<double> many = all_results(scene);
      CHECK(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)) == 0);
    }
    set_threads(before);
  }

  TEST_CASE("records of another set are refused") {
    const Scene<2> scene;
    const auto water = scene.records<float>(scene.water, 1);
    const auto wall = scene.records<float>(scene.wall, 2);
    const Mixed<2> pair{Kernel<2>(scene.h)};
    CHECK_THROWS_AS(
        gather<Mixed<2>::Sums>(scene.within, as(water), as(wall), pair, [](Index, const auto&) {}),
        Error);
  }

  TEST_CASE("finish runs for lonely targets of a set, not for those of a cross list") {
    const Scene<2> scene;
    std::vector<int> within(scene.water.size(), 0), across(scene.water.size(), 0);
    const auto water = scene.records<float>(scene.water, 1);
    const auto wall = scene.records<float>(scene.wall, 2);
    const Mixed<2> pair{Kernel<2>(scene.h)};
    gather<Mixed<2>::Sums>(scene.within, as(water), as(water), pair,
                           [&](Index i, const auto&) { ++within[static_cast<std::size_t>(i)]; });
    gather<Mixed<2>::Sums>(scene.across, as(water), as(wall), pair,
                           [&](Index i, const auto&) { ++across[static_cast<std::size_t>(i)]; });
    CHECK(std::count(within.begin(), within.end(), 1) == static_cast<long>(within.size()));
    CHECK(std::count(across.begin(), across.end(), 1) == scene.across.active());
    CHECK(scene.across.active() < static_cast<Index>(across.size()));
    CHECK(scene.across.active() > 0);
  }
}
