#include "core/indices_where.h"

#include <doctest/doctest.h>

#include "core/hash.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("indices of some kind are found in order, by any number of threads") {
    constexpr Index n = 50000;
    const auto holds = [](Index i) {
      // None in some blocks, all in others.
      return i > 30000 || (i < 10000 && random_uniform(7, static_cast<std::uint64_t>(i)) < 0.3);
    };
    std::vector<std::uint32_t> expected;
    for (Index i = 0; i < n; ++i)
      if (holds(i)) expected.push_back(static_cast<std::uint32_t>(i));
    for (const int count : {1, 3}) {
      set_threads(count);
      CHECK(indices_where(n, holds) == expected);
    }
    set_threads(2);
    CHECK(indices_where(0, holds).empty());
    CHECK(indices_where(n, [](Index) { return false; }).empty());
  }
}
