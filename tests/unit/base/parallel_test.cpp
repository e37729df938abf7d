#include "pipeline/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/base/random.h"

namespace blockrand::base {
namespace {

void jitter(std::size_t i) {
  std::this_thread::sleep_for(std::chrono::microseconds(random_bits(7, i, "jitter") % 300));
}

struct Case {
  int workers;
  std::size_t in_flight;
};

class OrderedParallel : public testing::TestWithParam<Case> {};

TEST_P(OrderedParallel, ConsumesEveryItemOnceAndInOrder) {
  constexpr std::size_t count = 500;
  std::vector<int> worked(count);
  std::vector<std::size_t> consumed;
  ordered_parallel(
      count, GetParam().workers, GetParam().in_flight,
      [&](std::size_t i) {
        jitter(i);
        ++worked[i];
      },
      [&](std::size_t i) {
        EXPECT_EQ(worked[i], 1);
        consumed.push_back(i);
      });
  std::vector<std::size_t> expected(count);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(consumed, expected);
}

TEST_P(OrderedParallel, NeverHasMoreItemsInFlightThanAllowed) {
  std::atomic<std::size_t> now = 0, most = 0;
  ordered_parallel(
      300, GetParam().workers, GetParam().in_flight,
      [&](std::size_t i) {
        const std::size_t n = ++now;
        for (std::size_t seen = most; n > seen && !most.compare_exchange_weak(seen, n);) {
        }
        jitter(i);
      },
      [&](std::size_t) { --now; });
  EXPECT_LE(most, std::max<std::size_t>(1, GetParam().in_flight));
  EXPECT_EQ(now, 0u);
}

TEST_P(OrderedParallel, TheLowestFailureEndsTheLoopAsInASerialOne) {
  std::vector<std::size_t> consumed;
  const auto run = [&] {
    ordered_parallel(
        200, GetParam().workers, GetParam().in_flight,
        [&](std::size_t i) {
          // The later item fails first.
          if (i == 60) std::this_thread::sleep_for(std::chrono::milliseconds(5));
          if (i == 60 || i == 61) throw std::runtime_error(std::to_string(i));
        },
        [&](std::size_t i) { consumed.push_back(i); });
  };
  try {
    run();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "60");
  }
  ASSERT_EQ(consumed.size(), 60u);
  EXPECT_EQ(consumed.back(), 59u);
}

TEST_P(OrderedParallel, AFailedConsumptionIsTheLast) {
  std::vector<std::size_t> consumed;
  EXPECT_THROW(ordered_parallel(100, GetParam().workers, GetParam().in_flight, jitter,
                                [&](std::size_t i) {
                                  consumed.push_back(i);
                                  if (i == 10) throw std::logic_error("stop");
                                }),
               std::logic_error);
  EXPECT_EQ(consumed.size(), 11u);
}

INSTANTIATE_TEST_SUITE_P(Threads, OrderedParallel,
                         testing::Values(Case{1, 1}, Case{1, 8}, Case{2, 1}, Case{2, 3}, Case{4, 4}, Case{8, 64},
                                         Case{3, 1000}, Case{4, 0}),
                         [](const auto& info) {
                           return std::to_string(info.param.workers) + "Workers" +
                                  std::to_string(info.param.in_flight) + "InFlight";
                         });

TEST(OrderedParallelEdge, NoItemsCallNothing) {
  const auto never = [](std::size_t) { FAIL(); };
  ordered_parallel(0, 4, 4, never, never);
}

TEST(OrderedParallelEdge, ConsumersNeverOverlap) {
  std::mutex mutex;
  ordered_parallel(
      2000, 4, 16, [](std::size_t) {},
      [&](std::size_t) {
        const std::unique_lock lock(mutex, std::try_to_lock);
        EXPECT_TRUE(lock.owns_lock());
      });
}

TEST_P(OrderedParallel, WhatAnItemSharesIsDoneOnceAndBeforeItEnds) {
  std::vector<std::vector<std::atomic<int>>> done(3);
  for (auto& of : done) of = std::vector<std::atomic<int>>(200);
  ordered_parallel(
      done.size(), GetParam().workers, GetParam().in_flight,
      [&](std::size_t i) {
        share(done[i].size(), [&](std::size_t k) { ++done[i][k]; });
        for (const std::atomic<int>& d : done[i]) EXPECT_EQ(d, 1);
      },
      [&](std::size_t i) { share(2, [&](std::size_t k) { done[i][k] += 10; }); });
  for (const auto& of : done)
    for (std::size_t k = 0; k < of.size(); ++k) EXPECT_EQ(of[k], k < 2 ? 11 : 1);
}

TEST_P(OrderedParallel, TheLowestSharedFailureIsThrownToItsItem) {
  std::atomic<int> thrown = 0, inner = 0;
  ordered_parallel(
      4, GetParam().workers, GetParam().in_flight,
      [&](std::size_t) {
        try {
          share(50, [&](std::size_t k) {
            share(3, [&](std::size_t) { ++inner; });
            if (k % 20 == 7) throw std::runtime_error(std::to_string(k));
          });
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "7");
          ++thrown;
        }
      },
      [](std::size_t) {});
  EXPECT_EQ(thrown, 4);
  EXPECT_GE(inner, 4 * 8 * 3);
}

TEST(Share, IdleThreadsHelpTheOnlyItem) {
  std::mutex mutex;
  std::condition_variable both;
  int inside = 0;
  bool met = false;
  ordered_parallel(
      1, 2, 1,
      [&](std::size_t) {
        share(2, [&](std::size_t) {  // ends at once when two threads are within
          std::unique_lock lock(mutex);
          met = met || ++inside == 2;
          both.notify_all();
          both.wait_for(lock, std::chrono::seconds(60), [&] { return met; });
        });
      },
      [](std::size_t) {});
  EXPECT_TRUE(met);
}

TEST(Share, StretchesCoverAllOnce) {
  EXPECT_EQ(stretches_to_share(0), (std::vector<std::size_t>{0}));
  EXPECT_EQ(stretches_to_share(9), (std::vector<std::size_t>{0, 9}));
  for (const std::size_t count : {1, 2, 5, 100})
    ordered_parallel(
        1, 4, 1,
        [&](std::size_t) {
          // Others begin to wait a moment after this item began.
          for (int i = 0; sharing_threads() < 4 && i < 10000; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          const std::vector<std::size_t> begins = stretches_to_share(count);
          EXPECT_EQ(begins.size(), std::min<std::size_t>(count, 12) + 1);
          EXPECT_EQ(begins.front(), 0u);
          EXPECT_EQ(begins.back(), count);
          for (std::size_t i = 1; i < begins.size(); ++i) EXPECT_LT(begins[i - 1], begins[i]);
        },
        [](std::size_t) {});
}

/// A large tile beside a small one, and none left: the thread of the small one will help.
TEST(Share, ThreadsOfLastItemsCount) {
  std::mutex mutex;
  std::condition_variable changed;
  bool begun = false, asked = false;
  std::size_t threads = 0;
  const auto wait_for = [&](std::unique_lock<std::mutex>& lock, const bool& what) {
    changed.notify_all();
    changed.wait_for(lock, std::chrono::seconds(60), [&] { return what; });
  };
  ordered_parallel(
      2, 2, 2,
      [&](std::size_t i) {
        std::unique_lock lock(mutex);
        if (i == 1) {
          begun = true;
          wait_for(lock, asked);
          return;
        }
        wait_for(lock, begun);
        threads = sharing_threads();
        asked = true;
        changed.notify_all();
      },
      [](std::size_t) {});
  EXPECT_EQ(threads, 2u);
}

TEST(Share, OutsideOfALoopTheCallerDoesAll) {
  std::vector<std::size_t> order;
  share(3, [&](std::size_t i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(sharing_threads(), 1u);
}

TEST(ItemLoads, HeavyItemsAreWorkedOnAlone) {
  constexpr std::size_t kMost = 5;
  const auto weight = [](std::size_t i) { return i % 4 == 0 ? std::size_t{9} : i % 3 + 1; };
  std::mutex mutex;
  std::size_t running = 0, load = 0, heaviest = 0, helped = 0;
  std::vector<std::size_t> order;
  ordered_parallel(
      200, 4, 8,
      [&](std::size_t i) {
        {
          const std::scoped_lock lock(mutex);
          ++running, load += weight(i);
          if (running > 1) heaviest = std::max(heaviest, load);
        }
        share(3, [&](std::size_t k) {
          jitter(i + k);
          const std::scoped_lock lock(mutex);
          ++helped;
        });
        const std::scoped_lock lock(mutex);
        --running, load -= weight(i);
      },
      [&](std::size_t i) { order.push_back(i); }, {weight, kMost});
  EXPECT_LE(heaviest, kMost);
  EXPECT_EQ(helped, 600u);
  ASSERT_EQ(order.size(), 200u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(WorkerCount, ZeroMeansOnePerCore) {
  EXPECT_GE(worker_count(0), 1);
  EXPECT_EQ(worker_count(3), 3);
}

}  // namespace
}  // namespace blockrand::base
