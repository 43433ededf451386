// The channels between the threads, as they ship, under every order that their atomics allow; and each of
// those orders is needed, or the table below says why it cannot be missed.
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/latency/channel_model.hpp"

namespace orcart::testing {
namespace {

constexpr std::uint64_t kSchedules = 10'000;

struct Expected {
  Channel channel;
  std::size_t needed;     ///< accesses whose order the checker must miss when it is taken away
  std::size_t redundant;  ///< and those it need not miss, for the reason below
};

class ChannelModel : public ::testing::TestWithParam<Expected> {};

TEST_P(ChannelModel, HoldsUnderEveryScheduleTried) {
  const ModelVerdict verdict = check_channel(GetParam().channel, kSchedules);
  EXPECT_TRUE(verdict.holds) << verdict.fault << " at schedule " << verdict.schedules;
}

TEST_P(ChannelModel, BreaksWhereOneOfItsOrdersIsRelaxed) {
  const ModelVerdict shipped = check_channel(GetParam().channel, 200);
  ASSERT_FALSE(shipped.ordered.empty());
  std::size_t noticed = 0;
  for (const AtomicSite& site : shipped.ordered) {
    const ModelVerdict weakened = check_channel(GetParam().channel, kSchedules, site);
    std::printf("  %s:%u relaxed: %s\n", site.file.c_str(), site.line,
                weakened.holds
                    ? "not noticed"
                    : (weakened.fault + " at schedule " + std::to_string(weakened.schedules)).c_str());
    if (weakened.holds) continue;
    ++noticed;
    EXPECT_FALSE(weakened.history.empty());
  }
  EXPECT_EQ(noticed, GetParam().needed);
  EXPECT_EQ(shipped.ordered.size() - noticed, GetParam().redundant);
}

// Each count is the number of places in the source that ask for an order.
// - queue: release and acquire of the tail (the element is there) and of the head (its slot is free again).
// - queue_size: those but the acquire of the head by the producer, which never finds the queue full, and the
// acquire
//   in size().
// - mailbox: the two exchanges.
// - pool: the release and acquire of the tail, on the way out and home alike. Those of the head are redundant
// here: no
//   more handles are under way than either queue holds, and they go round in turn, so a handle that came back
//   over one queue has brought along that the other's older slots were read.
// - trace_ring: release and acquire of its words and of its count.
INSTANTIATE_TEST_SUITE_P(AsShipped, ChannelModel,
                         ::testing::Values(Expected{Channel::queue, 4, 0},
                                           Expected{Channel::queue_size, 4, 0},
                                           Expected{Channel::mailbox, 2, 0}, Expected{Channel::pool, 2, 2},
                                           Expected{Channel::trace_ring, 4, 0}));

}  // namespace
}  // namespace orcart::testing
