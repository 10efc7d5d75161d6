#include "core/stopwatch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <thread>

#include "support/memory_state.h"

using namespace sphgeo;

namespace {

// Some milliseconds of work that the compiler cannot leave out.
double work() {
  double x = 1;
  for (int k = 0; k < 300'000; ++k) x = std::sin(x) + 1;
  return x;
}

}  // namespace

TEST_SUITE("core") {
  TEST_CASE("a stopwatch counts the processor time of all threads in loops") {
    const int before = threads();
    for (const int n : {1, 3}) {
      set_threads(n);
      // What the blocks took, measured in their own threads.
      std::vector<double> own(12, 0);
      Spent spent;
      {
        const Stopwatch watch(spent);
        parallel_blocks(12, 1, [&](Index b, Index, Index) {
          timespec from{}, to{};
          clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
          own[static_cast<std::size_t>(b)] = 0 * work();
          clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
          own[static_cast<std::size_t>(b)] += static_cast<double>(to.tv_sec - from.tv_sec) +
                                              1e-9 * static_cast<double>(to.tv_nsec - from.tv_nsec);
        });
      }
      double sum = 0;
      for (const double s : own) sum += s;
      CHECK(spent.processor >= sum);
      CHECK(spent.processor <= n * spent.seconds + 1e-3);
    }
    set_threads(before);
  }

  TEST_CASE("a quiet watch divides the loops among the threads, and nothing else") {
    const int before = threads();
    for (const int n : {1, 3}) {
      set_threads(n);
      const QuietWatch quiet;
      const double shared = shared_processor_seconds(), all = loop_processor_seconds();
      std::vector<double> kept(13, 0);
      kept[12] = work();
      parallel_blocks(12, 1,
                      [&](Index b, Index, Index) { kept[static_cast<std::size_t>(b)] = work(); });
      const double loops = shared_processor_seconds() - shared,
                   whole = loop_processor_seconds() - all;
      if (n == 1) CHECK(loops == 0);
      else CHECK(loops > 0.5 * whole);  // 12 of 13 parts
      const double at_once = std::min<double>(n, std::max(1u, std::thread::hardware_concurrency()));
      CHECK(quiet.seconds() >= whole - loops * (1 - 1 / at_once) - 1e-3);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      CHECK(quiet.seconds() < whole - loops * (1 - 1 / at_once) + 0.02);
    }
    set_threads(before);
  }

  TEST_CASE("what was spent with one thread and then with three is busy by what each had") {
    const int before = threads();
    Spent spent;
    for (const int n : {1, 3}) {
      set_threads(n);
      const Stopwatch watch(spent);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    set_threads(before);
    CHECK(spent.offered >= 1 * 0.02 + 3 * 0.02);
    CHECK(spent.offered < 3 * spent.seconds);
    spent.processor = 0.5 * spent.offered;
    CHECK(spent.busy() == 0.5);
    CHECK(Spent{}.busy() == 0);
    test::MemoryState state;
    put_spent(state, "spent", spent);
    CHECK(spent_of(state, "spent").busy() == 0.5);
    CHECK(spent_of(state, "spent").seconds == spent.seconds);
  }

  TEST_CASE("waiting is no processor time") {
    Spent spent;
    {
      const Stopwatch watch(spent);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    CHECK(spent.seconds >= 0.05);
    CHECK(spent.processor < 0.02);
  }

  TEST_CASE("of many short calls some stand for all") {
    Spent spent;
    for (long n = 0; n < 1000; ++n) const Stopwatch watch(spent, n);
    CHECK(spent.seconds > 0);
    CHECK(spent.processor > 0);
  }
}
