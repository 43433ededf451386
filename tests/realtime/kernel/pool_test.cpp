// The buffer pool: slots go out and come home, exhaustion and double returns are counted, two threads share
// it.
#include "realtime/kernel/pool.hpp"

#include <set>
#include <thread>

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Pool, GivesEachSlotOutOnceAndCountsExhaustion) {
  Pool<int> pool(3);
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 3; ++i) seen.insert(pool.take().value().index);
  EXPECT_EQ(seen.size(), 3u);
  EXPECT_FALSE(pool.take().has_value());
  EXPECT_FALSE(pool.take().has_value());
  EXPECT_EQ(pool.exhausted(), 2u);
}

TEST(Pool, GivesOutAgainWhatCameHome) {
  Pool<int> pool(1);
  const PoolHandle handle = pool.take().value();
  pool[handle] = 42;
  pool.give_back(handle);
  const auto again = pool.take();
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(*again, handle);
  EXPECT_EQ(pool[*again], 42);
  EXPECT_EQ(pool.exhausted(), 0u);
}

TEST(Pool, LetsTheOwnerPutBackWhatItNeverHandedOn) {
  Pool<int> pool(1);
  pool.put_back(pool.take().value());
  EXPECT_EQ(pool.reclaim(), 1u);
}

TEST(Pool, RefusesASlotThatIsGivenBackTwice) {
  Pool<int> pool(2);
  const PoolHandle handle = pool.take().value();
  pool.give_back(handle);
  pool.give_back(handle);
  EXPECT_EQ(pool.reclaim(), 2u);
  EXPECT_EQ(pool.refused(), 1u);
}

TEST(Pool, RefusesAHandleThatIsNotItsOwn) {
  Pool<int> pool(2);
  pool.put_back({99});
  EXPECT_EQ(pool.refused(), 1u);
  EXPECT_EQ(pool.reclaim(), 2u);
}

TEST(Pool, BetweenTwoThreadsNeverLendsASlotThatIsStillInUse) {
  constexpr int kFrames = 20'000;
  Pool<int> pool(4);
  SpscQueue<PoolHandle> lane(4);
  std::thread owner([&] {
    for (int sent = 1; sent <= kFrames;) {
      const auto handle = pool.take();
      if (!handle) {
        std::this_thread::yield();
        continue;
      }
      pool[*handle] = sent++;
      lane.try_push(*handle);
    }
  });
  int wrong = 0;
  for (int expected = 1; expected <= kFrames;) {
    PoolHandle handle;
    if (!lane.try_pop(handle)) {
      std::this_thread::yield();
      continue;
    }
    wrong += pool[handle] != expected++ ? 1 : 0;
    pool.give_back(handle);
  }
  owner.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(lane.dropped(), 0u);
  EXPECT_EQ(pool.refused(), 0u);
  EXPECT_EQ(pool.reclaim(), 4u);
}

}  // namespace
}  // namespace orcart
