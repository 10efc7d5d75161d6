#pragma once
// Parallel loops whose results do not depend on the number of threads: work is cut into blocks of
// fixed size, and whatever is summed is summed per block, then in block order.

#include <omp.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Number of items in one block of work.
inline constexpr int block_size = 256;

/// Sets the number of threads of all later loops (at least 1).
inline void set_threads(int n) { omp_set_num_threads(std::max(n, 1)); }

/// Number of threads that the next loop uses.
inline int threads() { return omp_get_max_threads(); }

/// Calls f(begin, end, block_index) for blocks of `block` items that cover [0, n). Blocks run in any
/// order and at the same time; f may write only what belongs to its block. If blocks throw, all
/// others still run and the exception of the first block (in block order) is rethrown.
template <class F>
void parallel_blocks(Index n, int block, F&& f) {
  const Index blocks = (n + block - 1) / block;
  std::exception_ptr failure;
  Index failed_block = blocks;
#pragma omp parallel for schedule(dynamic) if (blocks > 1)
  for (Index b = 0; b < blocks; ++b) {
    try {
      f(b * block, std::min<Index>(n, (b + 1) * block), b);
    } catch (...) {
#pragma omp critical(sphgeo_parallel_failure)
      if (b < failed_block) {
        failed_block = b;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls f(i) for all i in [0, n), in parallel blocks.
template <class F>
void parallel_for(Index n, F&& f) {
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index) {
    for (Index i = begin; i < end; ++i) f(i);
  });
}

namespace detail {

// What a sum is kept in: Eigen expressions become their plain matrix, everything else its own type.
template <class R, class = void>
struct SumType {
  using type = R;
  static R zero() { return R{}; }
};
template <class R>
struct SumType<R, std::void_t<typename R::PlainObject>> {
  using type = typename R::PlainObject;
  static type zero() { return type::Zero(); }
};

template <class F, class Better>
double block_extreme(Index n, double start, F& f, Better better) {
  std::vector<double> part(static_cast<std::size_t>((n + block_size - 1) / block_size), start);
  // A NaN counts as better than anything and stays, so that a guard sees it.
  const auto take = [&](double a, double b) { return (better(b, a) || b != b) ? b : a; };
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index b) {
    double best = start;
    for (Index i = begin; i < end; ++i) best = take(best, f(i));
    part[static_cast<std::size_t>(b)] = best;
  });
  double best = start;
  for (const double v : part) best = take(best, v);
  return best;
}

}  // namespace detail

/// Sum of f(i) over [0, n): bit for bit the same for any number of threads. f returns a double, an
/// Eigen vector or matrix of fixed size, or a struct whose `{}` is zero and which has `+=`.
template <class F>
auto ordered_sum(Index n, F&& f) {
  using S = detail::SumType<std::decay_t<std::invoke_result_t<F&, Index>>>;
  using R = typename S::type;
  std::vector<R> part(static_cast<std::size_t>((n + block_size - 1) / block_size), S::zero());
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index b) {
    R sum = S::zero();
    for (Index i = begin; i < end; ++i) sum += f(i);
    part[static_cast<std::size_t>(b)] = sum;
  });
  R sum = S::zero();
  for (const R& p : part) sum += p;
  return sum;
}

/// Largest f(i) over [0, n), `start` if n = 0 or all are smaller; NaN if any f(i) is NaN.
template <class F>
double block_max(Index n, F&& f, double start = -std::numeric_limits<double>::infinity()) {
  return detail::block_extreme(n, start, f, [](double a, double b) { return a > b; });
}

/// Smallest f(i) over [0, n), `start` if n = 0 or all are larger; NaN if any f(i) is NaN.
template <class F>
double block_min(Index n, F&& f, double start = std::numeric_limits<double>::infinity()) {
  return detail::block_extreme(n, start, f, [](double a, double b) { return a < b; });
}

}  // namespace sphgeo
