// The latest-value mailbox: newest wins, nothing is taken twice, and two real threads never see a torn value.
#include "realtime/kernel/mailbox.hpp"

#include <array>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(LatestMailbox, GivesNothingBeforeTheFirstPost) {
  LatestMailbox<int> mailbox;
  int value = 7;
  EXPECT_FALSE(mailbox.take(value));
  EXPECT_EQ(value, 7);
}

TEST(LatestMailbox, GivesTheNewestOfSeveralPosts) {
  LatestMailbox<int> mailbox;
  for (int i = 1; i <= 5; ++i) mailbox.post(i);
  int value = 0;
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_EQ(value, 5);
}

TEST(LatestMailbox, GivesEachValueOnce) {
  LatestMailbox<int> mailbox;
  mailbox.post(1);
  int value = 0;
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_FALSE(mailbox.take(value));
  mailbox.post(2);
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_EQ(value, 2);
}

TEST(LatestMailbox, BetweenTwoThreadsIsNeverTornOrOld) {
  constexpr std::uint64_t kPosts = 50'000;
  using Value = std::array<std::uint64_t, 8>;
  LatestMailbox<Value> mailbox;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kPosts; ++i) {
      Value value;
      value.fill(i);
      mailbox.post(value);
    }
  });
  std::uint64_t torn = 0;
  std::uint64_t old = 0;
  std::uint64_t last = 0;
  Value value{};
  while (last != kPosts) {
    if (!mailbox.take(value)) {
      std::this_thread::yield();
      continue;
    }
    for (const std::uint64_t word : value) torn += word != value[0] ? 1 : 0;
    old += value[0] <= last ? 1 : 0;
    last = value[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(old, 0u);
}

}  // namespace
}  // namespace orcart
