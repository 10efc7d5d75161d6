#pragma once
// Parallel loops whose results do not depend on the number of threads: work is cut into blocks of
// fixed size, and whatever is summed is summed per block, then in block order.

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Number of items in one block of work.
inline constexpr int block_size = 256;

/// Sets the number of threads of all later loops (at least 1).
void set_threads(int n);

/// Number of threads that the next loop uses: all processors, unless set_threads says otherwise.
int threads();

/// Processor time so far of the calling thread, and of the other threads in its loops, s: the
/// latter as far as a CountedLoops lived.
double loop_processor_seconds();

/// Of it that of all threads in loops that they share.
double shared_processor_seconds();

/// During its lifetime the processor time of all threads in loops is counted, which takes a
/// microsecond a loop.
class CountedLoops {
 public:
  CountedLoops();
  ~CountedLoops();
  CountedLoops(const CountedLoops&) = delete;
  CountedLoops& operator=(const CountedLoops&) = delete;
};

/// From now on all loops of the calling thread run in it alone: for a thread that works beside the
/// one whose loops all threads share, and would take them from it.
void keep_loops_to_this_thread();

namespace detail {

/// Calls call(context, b) for all b in [0, blocks), in several threads.
void run_blocks(Index blocks, void (*call)(const void* context, Index b), const void* context);

}  // namespace detail

/// Calls f(begin, end, block_index) for blocks of `block` items that cover [0, n). Blocks run in
/// any order and at the same time; f may write only what belongs to its block. A loop inside of f
/// runs in the thread of f. If blocks throw, all others still run and the exception of the first
/// block (in block order) is rethrown.
template <class F>
void parallel_blocks(Index n, int block, F&& f) {
  const auto one = [&](Index b) { f(b * block, std::min<Index>(n, (b + 1) * block), b); };
  detail::run_blocks((n + block - 1) / block,
                     [](const void* loop, Index b) { (*static_cast<decltype(&one)>(loop))(b); },
                     &one);
}

/// Calls f(i) for all i in [0, n), in parallel blocks.
template <class F>
void parallel_for(Index n, F&& f) {
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index) {
    for (Index i = begin; i < end; ++i) f(i);
  });
}

/// The larger; NaN if either is NaN, so that a guard sees it.
inline double max_or_nan(double a, double b) { return b > a || b != b ? b : a; }
/// The smaller; NaN if either is NaN.
inline double min_or_nan(double a, double b) { return b < a || b != b ? b : a; }

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
  parallel_blocks(n, block_size, [&](Index begin, Index end, Index b) {
    double best = start;
    for (Index i = begin; i < end; ++i) best = better(best, f(i));
    part[static_cast<std::size_t>(b)] = best;
  });
  double best = start;
  for (const double v : part) best = better(best, v);
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
  return detail::block_extreme(n, start, f, max_or_nan);
}

/// Smallest f(i) over [0, n), `start` if n = 0 or all are larger; NaN if any f(i) is NaN.
template <class F>
double block_min(Index n, F&& f, double start = std::numeric_limits<double>::infinity()) {
  return detail::block_extreme(n, start, f, min_or_nan);
}

}  // namespace sphgeo
