// The simulated pedal line: the seam's contract, contact bounce, lost edges, an unplugged chip, a live pedal.
#include "board/sim/simulated_gpio.hpp"

#include <memory>

#include "tests/board/ports/gpio_contract.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

class SimulatedGpioRig final : public testing::GpioRig {
 public:
  Clock& clock() override { return clock_; }
  void schedule(const std::vector<testing::EdgeAfter>& edges) override {
    GpioScript script;
    for (const auto& edge : edges)
      script.edges.push_back({.at = clock_.now() + edge.after, .kind = edge.kind});
    lines_ = std::make_unique<SimulatedGpio>(clock_, script);
  }
  GpioLines& lines() override { return *lines_; }

 private:
  SimulatedClock clock_;
  std::unique_ptr<SimulatedGpio> lines_;
};

const Instant kStart = SimulatedClock().now();
const GpioScript kOnePress{.edges = {{.at = kStart + 10ms, .kind = EdgeKind::pressed},
                                     {.at = kStart + 90ms, .kind = EdgeKind::released}}};

TEST(SimulatedGpio, NamesTheInstantOfItsNextEdge) {
  SimulatedClock clock;
  SimulatedGpio lines(clock, kOnePress);
  EXPECT_EQ(lines.next_event(), kStart + 10ms);
  lines.wait(kStart + 1s);
  ASSERT_TRUE(lines.take_edge());
  EXPECT_EQ(lines.next_event(), kStart + 90ms);
  lines.wait(kStart + 1s);
  ASSERT_TRUE(lines.take_edge());
  EXPECT_EQ(lines.next_event(), Instant::max());
}

TEST(SimulatedGpio, ChattersAfterEveryEdgeAndEndsInItsState) {
  GpioScript script = kOnePress;
  script.bounce = {.pairs = 2, .spacing = 1ms};
  const auto edges = edges_on_the_line(script);
  ASSERT_EQ(edges.size(), 10U);
  EXPECT_EQ(edges[4].kind, EdgeKind::pressed);
  EXPECT_EQ(edges[4].at, kStart + 14ms);
  EXPECT_EQ(edges[9].kind, EdgeKind::released);
  for (std::size_t i = 1; i < edges.size(); ++i) EXPECT_NE(edges[i].kind, edges[i - 1].kind);
}

TEST(SimulatedGpio, LeavesAGapInTheSequenceForALostEdge) {
  GpioScript script = kOnePress;
  script.lost = {1};
  const auto edges = edges_on_the_line(script);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].sequence, 2U);
}

TEST(SimulatedGpio, SaysDisconnectedFromTheInstantItIsUnplugged) {
  SimulatedClock clock;
  GpioScript script = kOnePress;
  script.gone_at = kStart + 50ms;
  SimulatedGpio lines(clock, script);
  lines.wait(kStart + 1s);
  EXPECT_TRUE(lines.take_edge());
  lines.wait(kStart + 1s);
  EXPECT_EQ(clock.now(), kStart + 50ms);
  EXPECT_EQ(lines.take_edge().error(), PortFault::disconnected);
  EXPECT_EQ(lines.pulse_trigger(clock.now(), 1ms).error(), PortFault::disconnected);
}

TEST(SimulatedGpio, MixesALivePedalIntoTheSequence) {
  SimulatedClock clock;
  LivePedal live;
  SimulatedGpio lines(clock, kOnePress, &live);
  ASSERT_TRUE(live.push(EdgeKind::pressed, kStart));
  lines.wait(kStart + 1s);
  EXPECT_EQ(clock.now(), kStart);
  EXPECT_EQ(lines.take_edge()->sequence, 1U);
  lines.wait(kStart + 1s);
  EXPECT_EQ(lines.take_edge()->sequence, 2U);
}

TEST(SimulatedGpio, RecordsTriggerPulses) {
  SimulatedClock clock;
  SimulatedGpio lines(clock, {});
  ASSERT_TRUE(lines.pulse_trigger(kStart + 3ms, 2ms));
  ASSERT_EQ(lines.pulses().size(), 1U);
  EXPECT_EQ(lines.pulses()[0].rise, kStart + 3ms);
  EXPECT_EQ(lines.pulses()[0].width, 2ms);
}

TEST(SimulatedGpio, AllocatesNothingWhileItRuns) {
  SimulatedClock clock;
  SimulatedGpio lines(clock, kOnePress);
  EXPECT_TRUE(testing::zero_allocation([&] {
    lines.wait(kStart + 1s);
    (void)lines.take_edge();
    (void)lines.pulse_trigger(clock.now(), 1ms);
  }));
}

}  // namespace

namespace testing {
INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, GpioContract, SimulatedGpioRig);
}
}  // namespace orcart
