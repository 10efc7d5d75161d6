#include "core/side_thread.h"

#include <doctest/doctest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/parallel.h"

using namespace sphgeo;

TEST_SUITE("core") {
  TEST_CASE("tasks run beside their giver, in order and one at a time") {
    std::vector<int> order;
    {
      SideThread side;
      CHECK(side.idle());
      side.wait();  // for nothing
      std::promise<void> go;
      side.begin([&, go_on = go.get_future().share()] {
        go_on.wait();
        order.push_back(1);
      });
      CHECK_FALSE(side.idle());
      side.check();
      go.set_value();
      for (const int k : {2, 3, 4}) side.begin([&order, k] { order.push_back(k); });
      side.wait();
      CHECK(side.idle());
      CHECK(order == std::vector<int>{1, 2, 3, 4});
      side.begin([&order] { order.push_back(5); });
    }  // the last one is waited for
    CHECK(order.size() == 5);
  }

  TEST_CASE("what a task throws arrives at each later call, and no other task is begun") {
    SideThread side;
    side.begin([] { throw std::runtime_error("the disk is full"); });
    CHECK_THROWS_WITH(side.wait(), "the disk is full");
    CHECK_THROWS_WITH(side.check(), "the disk is full");
    bool begun = false;
    CHECK_THROWS_WITH(side.begin([&] { begun = true; }), "the disk is full");
    CHECK_FALSE(begun);
    CHECK(side.idle());
  }

  TEST_CASE("what a task holds is free before the next one is made") {
    SideThread side;
    const auto memory = std::make_shared<int>(1);
    side.begin([memory] {});
    side.wait();
    CHECK(memory.use_count() == 1);
  }

  TEST_CASE("loops of a task take no thread from the loops beside it") {
    const int before = threads();
    set_threads(3);
    SideThread side;
    std::atomic<bool> elsewhere = false;
    std::atomic<Index> sum = 0;
    side.begin([&] {
      const auto mine = std::this_thread::get_id();
      for (int k = 0; k < 50; ++k)
        parallel_for(5000, [&](Index i) {
          if (std::this_thread::get_id() != mine) elsewhere = true;
          sum += i;
        });
    });
    double beside = 0;
    for (int k = 0; k < 50; ++k) beside += ordered_sum(5000, [](Index) { return 1.0; });
    side.wait();
    CHECK(beside == 250'000);
    CHECK_FALSE(elsewhere);
    CHECK(sum == 50 * (Index{5000} * 4999 / 2));
    set_threads(before);
  }
}
