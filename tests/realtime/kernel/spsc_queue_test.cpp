// The bounded queue: order, refusal when full, wrap-around, and two real threads.
#include "realtime/kernel/spsc_queue.hpp"

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(SpscQueue, HandsElementsOnInOrder) {
  SpscQueue<int> queue(4);
  EXPECT_TRUE(queue.try_push(1));
  EXPECT_TRUE(queue.try_push(2));
  int element = 0;
  EXPECT_TRUE(queue.try_pop(element));
  EXPECT_EQ(element, 1);
  EXPECT_TRUE(queue.try_pop(element));
  EXPECT_EQ(element, 2);
}

TEST(SpscQueue, LeavesTheElementAloneWhenEmpty) {
  SpscQueue<int> queue(2);
  int element = 7;
  EXPECT_FALSE(queue.try_pop(element));
  EXPECT_EQ(element, 7);
}

TEST(SpscQueue, RefusesAPushWhenFullAndCountsIt) {
  SpscQueue<int> queue(3);  // no power of two: the capacity is the one asked for
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.try_push(i));
  EXPECT_FALSE(queue.try_push(3));
  EXPECT_FALSE(queue.try_push(4));
  EXPECT_EQ(queue.dropped(), 2u);
  EXPECT_EQ(queue.size(), 3u);
}

TEST(SpscQueue, OfCapacityZeroRefusesEverything) {
  SpscQueue<int> queue(0);
  EXPECT_FALSE(queue.try_push(1));
  int element = 0;
  EXPECT_FALSE(queue.try_pop(element));
}

TEST(SpscQueue, KeepsOrderAndSizeOverManyWraps) {
  SpscQueue<int> queue(3);
  int next_out = 0;
  int element = -1;
  for (int next_in = 0; next_in < 1000; ++next_in) {
    ASSERT_TRUE(queue.try_push(next_in));
    if (queue.size() < 3) continue;
    ASSERT_TRUE(queue.try_pop(element));
    ASSERT_EQ(element, next_out++);
  }
  EXPECT_EQ(queue.size(), 2u);
  EXPECT_EQ(queue.dropped(), 0u);
}

struct TwoWords {
  std::uint64_t number = 0;
  std::uint64_t same_number = 0;
};

TEST(SpscQueue, BetweenTwoThreadsLosesNothingButWhatItCounted) {
  constexpr std::uint64_t kPushes = 50'000;
  SpscQueue<TwoWords> queue(8);
  std::atomic<bool> finished{false};
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kPushes; ++i) {
      if (!queue.try_push({i, i})) std::this_thread::yield();
    }
    finished.store(true, std::memory_order_release);  // partner: the acquire below
  });
  std::uint64_t received = 0;
  std::uint64_t torn = 0;
  std::uint64_t last = 0;
  std::uint64_t out_of_order = 0;
  TwoWords element;
  for (bool last_round = false; !last_round;) {
    last_round = finished.load(std::memory_order_acquire);
    while (queue.try_pop(element)) {
      torn += element.number != element.same_number ? 1 : 0;
      out_of_order += element.number <= last ? 1 : 0;
      last = element.number;
      ++received;
    }
    std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(out_of_order, 0u);
  EXPECT_EQ(received + queue.dropped(), kPushes);
}

}  // namespace
}  // namespace orcart
