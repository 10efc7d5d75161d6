// Times the pair loops on a block of water (not run by ctest):
//   bench_pairs [particles per edge = 53] [repeats = 7]
// One update is one particle through one acoustic step: the momentum pass (Riemann pressure with
// limiter, Eq. 61-63, and the viscous term of Eq. 60) and the density pass (Eq. 58). The machine
// may be busy: the best of all repeats counts, beside the rate of a calibration loop.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "sph/gather.h"
#include "sph/kernel.h"

namespace {

using namespace sphgeo;

struct Water : RecordType<3> {
  static constexpr RecordField<Water, 0, 3> position{};
  static constexpr RecordField<Water, 3> volume{};
  static constexpr RecordField<Water, 4, 3> velocity{};
  static constexpr RecordField<Water, 7> pressure{};
  static constexpr RecordSpec spec{"water",
                                   0,
                                   "",
                                   {{{"position", position},
                                     {"volume", volume},
                                     {"velocity", velocity},
                                     {"pressure", pressure}}}};
};
constexpr auto V = Water::volume;
constexpr auto v = Water::velocity;
constexpr auto p = Water::pressure;

struct Momentum {
  Kernel<3> kernel;
  double rho0 = 1000.0, c0 = 20.0, limiter = 15.0, viscosity = 1e-3;

  template <class T>
  struct Sums {
    LaneVec<3, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Water>& i, const Record<T, Water>& j,
                  const LaneVec<3, T>& r, const T& r2) const {
    const T dW_r = kernel.dw_over_r(r2) * j[V];
    const LaneVec<3, T> v_ij = i.vec(v) - j.vec(v);
    // Eq. 61 with equal impedances; U_L - U_R = -v_ij . e_ij
    const T closing = -dot(v_ij, r) * inverse_length(r2);
    const T beta = min(T(1.0), T(limiter / c0) * max(T(0.0), closing));
    const T p_star = T(0.5) * (i[p] + j[p] + beta * T(rho0 * c0) * closing);
    const T viscous =
        T(2.0 * viscosity) * r2 * dW_r * reciprocal(r2 + T(0.01 * kernel.h * kernel.h));
    sum.force += viscous * v_ij - T(2.0) * p_star * dW_r * r;
  }
};

struct Density {
  Kernel<3> kernel;
  double rho0 = 1000.0, c0 = 20.0;

  template <class T>
  struct Sums {
    T rate{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const Record<T, Water>& i, const Record<T, Water>& j,
                  const LaneVec<3, T>& r, const T& r2) const {
    const T dW_r = kernel.dw_over_r(r2) * j[V];
    const T divergence = dot(i.vec(v) - j.vec(v), r);
    sum.rate += dW_r * (divergence + (i[p] - j[p]) * T(1.0 / (rho0 * c0)) * length(r2));
  }
};

// Seconds; with one thread those it ran, so that other programs disturb less.
double now() {
  if (threads() == 1) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// Best rate of a loop of independent multiply-adds on single-precision lanes [Gflop/s, one thread]:
// what the machine gives at the moment.
double calibration() {
  double best = 0.0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    constexpr int chains = 10, rounds = 1000000;
    FloatLanes x[chains];
    for (int k = 0; k < chains; ++k) x[k] = 0.1 * k;
    const FloatLanes a = 0.999f, b = 1e-3f;
    const std::clock_t begin = std::clock();
    for (int n = 0; n < rounds; ++n)
      for (int k = 0; k < chains; ++k) x[k] = x[k] * a + b;
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    FloatLanes total = 0.0f;
    for (int k = 0; k < chains; ++k) total += x[k];
    // The sum is used, so that the loop stays.
    if (sum(total) > 0.0f)
      best = std::max(best, 2e-9 * chains * rounds * FloatLanes::width / seconds);
  }
  return best;
}

std::vector<Vec<3>> jittered_cube(int edge) {
  std::vector<Vec<3>> r;
  std::uint64_t n = 0;
  for (int z = 0; z < edge; ++z)
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) {
        Vec<3> at(x, y, z);
        for (int d = 0; d < 3; ++d) at[d] += 0.4 * (random_uniform(1, n++) - 0.5);
        r.push_back(0.01 * at);
      }
  return r;
}

template <class T>
void time_steps(const char* name, const NeighborList& list, const std::vector<Vec<3>>& r,
                const FixedPoint<3>& frame, double h, int repeats) {
  const auto n = static_cast<Index>(r.size());
  Records<3, T> in_a(n, frame), in_b(n, frame);
  const RecordPacking<Water, T> a(in_a), b(in_b);
  std::vector<Vec<3>> velocity(r.size());
  std::vector<double> density(r.size(), 1000.0);
  const Kernel<3> kernel(h);
  const auto pack = [&](const RecordPacking<Water, T>& to, Index i) {
    const auto k = static_cast<std::size_t>(i);
    const auto record = to[i];
    to.set_position(i, r[k]);
    record.put(V, 1e-6 * 1000.0 / density[k]);
    record.put(v, velocity[k]);
    record.put(p, 400.0 * (density[k] - 1000.0));
  };
  for (Index i = 0; i < n; ++i) {
    for (int d = 0; d < 3; ++d)
      velocity[static_cast<std::size_t>(i)][d] = 0.1 * (random_uniform(2, 3 * i + d) - 0.5);
    density[static_cast<std::size_t>(i)] += random_uniform(3, i) - 0.5;
    pack(a, i);
  }
  double best = 1e9, best_momentum = 1e9, best_density = 1e9;
  const double dt = 1e-7;
  for (int k = 0; k < repeats; ++k) {
    const double t0 = now();
    gather<Momentum::Sums>(list, a, a, Momentum{kernel}, [&](Index i, const auto& sum) {
      const auto q = static_cast<std::size_t>(i);
      for (int d = 0; d < 3; ++d) velocity[q][d] += dt / density[q] * sum.force[d];
      pack(b, i);
    });
    const double t1 = now();
    gather<Density::Sums>(list, b, b, Density{kernel}, [&](Index i, const auto& sum) {
      const auto q = static_cast<std::size_t>(i);
      density[q] += dt * density[q] * sum.rate;
      pack(a, i);
    });
    const double t2 = now();
    best = std::min(best, t2 - t0);
    best_momentum = std::min(best_momentum, t1 - t0);
    best_density = std::min(best_density, t2 - t1);
  }
  const double m = 1e-6 * static_cast<double>(n), pairs = 1e-9 * static_cast<double>(list.pairs());
  std::printf("  %-7s %5.2f Mupd/s   momentum %.2f, density %.2f Gpair/s\n", name, m / best,
              pairs / best_momentum, pairs / best_density);
}

}  // namespace

int main(int argc, char** argv) {
  const int edge = argc > 1 ? std::atoi(argv[1]) : 53;
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 7;
  std::printf("multiply-adds: %.0f Gflop/s\n", calibration());
  for (const double ratio : {1.3, 1.8}) {
    const double h = 0.01 * ratio;
    std::vector<Vec<3>> r = jittered_cube(edge);
    const double end = 0.01 * edge;
    const auto frame = FixedPoint<3>::fit(Vec<3>::Zero(), Vec<3>::Constant(end), 2 * h);
    CellGrid<3> grid;
    NeighborList list;
    double best_sort = 1e9, best_list = 1e9;
    std::vector<Vec<3>> sorted(r.size());
    for (int k = 0; k < repeats; ++k) {
      const double t0 = now();
      grid.build(r, frame, 2 * h);
      const auto order = grid.order();
      parallel_for(grid.size(), [&](Index i) {
        const auto q = static_cast<std::size_t>(i);
        sorted[q] = r[order[q]];
      });
      grid.set_sorted();
      r.swap(sorted);
      const double t1 = now();
      list.build<3>(r, grid, 2 * h, Pairing::within);
      const double t2 = now();
      best_sort = std::min(best_sort, t1 - t0);
      best_list = std::min(best_list, t2 - t1);
    }
    const double n = static_cast<double>(r.size());
    std::printf(
        "h = %.1f dp, %.0f particles, %.1f neighbors, %d threads, %.0f list bytes/particle\n",
        ratio, n, static_cast<double>(list.pairs()) / n, threads(),
        static_cast<double>(list.bytes()) / n);
    std::printf("  search  %.0f ns/particle (sort %.0f, list %.0f)\n",
                1e9 * (best_sort + best_list) / n, 1e9 * best_sort / n, 1e9 * best_list / n);
    time_steps<float>("float", list, r, frame, h, repeats);
    time_steps<double>("double", list, r, frame, h, repeats);
  }
}
