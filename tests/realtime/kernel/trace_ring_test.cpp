// The trace ring: newest events kept, oldest overwritten, and a reader beside a running writer sees whole
// ones only.
#include "realtime/kernel/trace_ring.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

TraceEvent event(std::int64_t number) {
  return {.at = instant_from_nanos(number),
          .length = Nanos{number},
          .stage = static_cast<std::uint16_t>(number),
          .kind = TraceKind::step,
          .frame = static_cast<std::uint32_t>(number),
          .value = number};
}

TEST(TraceRing, KeepsEventsInOrder) {
  TraceRing ring(8);
  for (int i = 1; i <= 3; ++i) ring.write(event(i));
  EXPECT_EQ(ring.snapshot(), (std::vector{event(1), event(2), event(3)}));
}

TEST(TraceRing, OverwritesTheOldest) {
  TraceRing ring(7);
  ASSERT_EQ(ring.capacity(), 7u);
  for (int i = 1; i <= 100; ++i) ring.write(event(i));
  const std::vector<TraceEvent> kept = ring.snapshot();
  ASSERT_EQ(kept.size(), 7u);
  EXPECT_EQ(kept.front(), event(94));
  EXPECT_EQ(kept.back(), event(100));
  EXPECT_EQ(ring.written(), 100u);
}

TEST(TraceRing, HoldsAtLeastTheCapacityAskedFor) {
  EXPECT_GE(TraceRing(1).capacity(), 1u);
  EXPECT_GE(TraceRing(8).capacity(), 8u);
  EXPECT_GE(TraceRing(1000).capacity(), 1000u);
}

TEST(TraceRing, GivesTheNewestWhereTheReaderHasLittleRoom) {
  TraceRing ring(7);
  for (int i = 1; i <= 5; ++i) ring.write(event(i));
  std::vector<TraceEvent> out(2);
  ASSERT_EQ(ring.read(out), 2u);
  EXPECT_EQ(out, (std::vector{event(4), event(5)}));
}

TEST(TraceRing, IsWrittenAndReadWithoutAllocating) {
  TraceRing ring(7);
  std::vector<TraceEvent> out(7);
  EXPECT_TRUE(testing::zero_allocation([&] {
    ring.write(event(1));
    ring.read(out);
  }));
}

TEST(TraceRing, ReadBesideARunningWriterGivesWholeEventsInOrder) {
  constexpr std::int64_t kEvents = 50'000;
  TraceRing ring(15);
  std::thread writer([&] {
    for (std::int64_t i = 1; i <= kEvents; ++i) ring.write(event(i));
  });
  std::vector<TraceEvent> out(15);
  int torn = 0;
  int out_of_order = 0;
  std::int64_t newest = 0;
  while (newest < kEvents) {
    const std::size_t count = ring.read(out);
    for (std::size_t i = 0; i < count; ++i) {
      torn += out[i] == event(out[i].value) ? 0 : 1;
      out_of_order += i > 0 && out[i].value != out[i - 1].value + 1 ? 1 : 0;
    }
    if (count > 0) newest = out[count - 1].value;
    std::this_thread::yield();
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(out_of_order, 0);
}

}  // namespace
}  // namespace orcart
