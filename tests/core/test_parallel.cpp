#include "core/parallel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/hash.h"

using namespace sphgeo;

namespace {

// Restores the number of threads.
struct ThreadsAtEnd {
  int n = threads();
  ~ThreadsAtEnd() { set_threads(n); }
};

}  // namespace

TEST_SUITE("core") {
  TEST_CASE("parallel_blocks covers every item once, with fixed blocks") {
    const ThreadsAtEnd restore;
    for (const int n_threads : {1, 3}) {
      set_threads(n_threads);
      for (const Index n : {0, 1, 255, 256, 257, 1000}) {
        std::vector<int> seen(static_cast<std::size_t>(n), 0);
        std::atomic<int> wrong = 0;
        parallel_blocks(n, 256, [&](Index begin, Index end, Index b) {
          if (begin != 256 * b || end <= begin || end - begin > 256) ++wrong;
          for (Index i = begin; i < end; ++i) ++seen[static_cast<std::size_t>(i)];
        });
        CHECK(wrong == 0);
        CHECK(std::count(seen.begin(), seen.end(), 1) == n);
      }
    }
  }

  TEST_CASE("the exception of the first failing block arrives, all other blocks run") {
    const ThreadsAtEnd restore;
    for (const int n_threads : {1, 4}) {
      set_threads(n_threads);
      std::atomic<int> ran = 0;
      std::string caught;
      try {
        parallel_blocks(100, 1, [&](Index i, Index, Index) {
          ++ran;
          if (i == 17 || i == 18 || i == 90) throw std::runtime_error(std::to_string(i));
        });
      } catch (const std::runtime_error& e) {
        caught = e.what();
      }
      CHECK(caught == "17");
      CHECK(ran == 100);
    }
  }

  TEST_CASE("a loop within a loop runs all its blocks in the thread at hand") {
    const ThreadsAtEnd restore;
    for (const int n_threads : {1, 4}) {
      set_threads(n_threads);
      std::vector<int> seen(40 * 30, 0);
      std::atomic<int> strangers = 0;
      parallel_blocks(40, 1, [&](Index a, Index, Index) {
        const auto self = std::this_thread::get_id();
        parallel_blocks(30, 1, [&](Index b, Index, Index) {
          if (std::this_thread::get_id() != self) ++strangers;
          ++seen[static_cast<std::size_t>(30 * a + b)];
        });
      });
      CHECK(strangers == 0);
      CHECK(std::count(seen.begin(), seen.end(), 1) == static_cast<long>(seen.size()));
    }
  }

  TEST_CASE("many short loops, with changing numbers of threads and pauses, lose no block") {
    const ThreadsAtEnd restore;
    long total = 0;
    std::vector<long> count(50);
    for (int k = 0; k < 3000; ++k) {
      set_threads(1 + k % 5);
      if (k % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      const Index n = k % 50;
      total += n;
      parallel_blocks(n, 1, [&](Index b, Index, Index) { ++count[static_cast<std::size_t>(b)]; });
    }
    long sum = 0;
    for (const long c : count) sum += c;
    CHECK(sum == total);
  }

  TEST_CASE("several threads take part in a loop") {
    const ThreadsAtEnd restore;
    set_threads(3);
    // Every block waits until three threads have come, however long a busy machine takes.
    std::atomic<int> here = 0;
    parallel_blocks(3, 1, [&](Index, Index, Index) {
      ++here;
      while (here < 3) std::this_thread::yield();
    });
    CHECK(here == 3);
  }

  TEST_CASE("ordered_sum has the same bits for any number of threads") {
    const ThreadsAtEnd restore;
    const auto value = [](Index i) {
      return std::exp(20 * random_uniform(5, static_cast<std::uint64_t>(i)) - 10);
    };
    const Index n = 10007;
    set_threads(1);
    const double one = ordered_sum(n, value);
    const Vec3 one3 = ordered_sum(n, [&](Index i) { return Vec3(value(i), 1, -value(i)); });
    long double exact = 0;
    for (Index i = 0; i < n; ++i) exact += value(i);
    CHECK(one == doctest::Approx(static_cast<double>(exact)).epsilon(1e-13));
    for (const int n_threads : {2, 3, 4, 7}) {
      set_threads(n_threads);
      CHECK(ordered_sum(n, value) == one);
      const Vec3 many = ordered_sum(n, [&](Index i) { return Vec3(value(i), 1, -value(i)); });
      CHECK(many == one3);
    }
    CHECK(one3[1] == static_cast<double>(n));
    CHECK(ordered_sum(0, value) == 0.0);
    // An expression of Eigen is summed as a vector, not kept as a reference to a dead one.
    const Vec3 twice = ordered_sum(3, [](Index i) { return Vec3::Constant(double(i)) * 2.0; });
    CHECK(twice == Vec3::Constant(6.0));
    CHECK(ordered_sum(0, [](Index) { return Vec3(1, 2, 3); }) == Vec3::Zero());
  }

  TEST_CASE("block_max and block_min find extremes and do not hide a NaN") {
    const auto value = [](Index i) { return static_cast<double>((i * 7919) % 1009); };
    CHECK(block_max(1009, value) == 1008.0);
    CHECK(block_min(1009, value, 5.0) == 0.0);
    CHECK(block_min(0, value, 5.0) == 5.0);
    CHECK(block_max(1, value, 5.0) == 5.0);
    for (const Index at : {0, 300, 999}) {
      const auto with_nan = [&](Index i) { return i == at ? std::nan("") : value(i); };
      CHECK(std::isnan(block_max(1000, with_nan)));
      CHECK(std::isnan(block_min(1000, with_nan)));
    }
  }

  TEST_CASE("random numbers are uniform, and those of different seeds and indices differ") {
    double mean = 0, square = 0;
    const int n = 20000;
    for (std::uint64_t i = 0; i < n; ++i) {
      const double u = random_uniform(42, i);
      REQUIRE(u >= 0.0);
      REQUIRE(u < 1.0);
      mean += u / n;
      square += u * u / n;
    }
    CHECK(mean == doctest::Approx(0.5).epsilon(0.02));
    CHECK(square == doctest::Approx(1.0 / 3).epsilon(0.02));
    CHECK(random_bits(1, 2) != random_bits(2, 1));
    CHECK(random_bits(1, 2) != random_bits(1, 3));
    CHECK(random_uniform(7, 7) == random_uniform(7, 7));
  }

  TEST_CASE("FNV-1a gives the published values") {
    CHECK(fnv1a("") == 0xcbf29ce484222325u);
    CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cu);
    CHECK(fnv1a("foobar") == 0x85944171f73967e8u);
    CHECK(fnv1a_bytes("foobar", 6) == fnv1a("bar", fnv1a("foo")));
  }
}
