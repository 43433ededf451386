// The pedal's policy over a played chip: pulses, lost edges, a chip that goes and comes back.
#include "board/linux/pedal/gpio_pedal.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

/// A chip in this process's memory; edges come when the clock reaches them.
struct PlayedChip final : LineKeeper {
  explicit PlayedChip(SimulatedClock& c) : clock(c) {}

  struct Lines final : RequestedLines {
    explicit Lines(PlayedChip& c) : chip(c) { ++chip.held; }
    ~Lines() override { --chip.held; }
    Result<RawEdge, PortFault> read() noexcept override {
      if (chip.gone) return tl::unexpected(PortFault::disconnected);
      if (chip.edges.empty() || chip.edges.front().at > chip.clock.now())
        return tl::unexpected(PortFault::nothing_yet);
      const RawEdge edge = chip.edges.front();
      chip.edges.pop_front();
      return edge;
    }
    Result<EdgeKind, PortFault> level() noexcept override {
      if (chip.gone) return tl::unexpected(PortFault::disconnected);
      return chip.level;
    }
    Result<void, PortFault> set_trigger(TriggerLevel level) noexcept override {
      if (chip.gone) return tl::unexpected(PortFault::disconnected);
      chip.trigger = level;
      chip.trigger_at = chip.clock.now();
      return {};
    }
    bool wait(Instant deadline) noexcept override {
      const Instant next = chip.edges.empty() ? deadline : std::min(deadline, chip.edges.front().at);
      chip.clock.advance_to(next + chip.held_up);
      return chip.gone || (!chip.edges.empty() && chip.edges.front().at <= chip.clock.now());
    }
    PlayedChip& chip;
  };

  Result<std::unique_ptr<RequestedLines>, GpioTrouble> request(const GpioWish& wish) noexcept override {
    ++requests;
    if (gone) return tl::unexpected(gpio_trouble("chip " + wish.chip, ENOENT));
    return std::make_unique<Lines>(*this);
  }

  SimulatedClock& clock;
  std::deque<RawEdge> edges;
  EdgeKind level = EdgeKind::released;
  TriggerLevel trigger = TriggerLevel::idle;
  Instant trigger_at{};
  Nanos held_up{};  ///< how late a thread comes back from waiting
  bool gone = false;
  int held = 0, requests = 0;
};

class GpioPedalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = GpioPedal::open({.chip = "gpiochip0", .line = "4", .trigger_line = "5"}, clock, chip);
    ASSERT_TRUE(opened) << opened.error().message;
    pedal = std::move(*opened);
  }
  void press_at(Instant at) {
    chip.edges.push_back({.kind = EdgeKind::pressed, .at = at, .number = std::nullopt});
  }

  SimulatedClock clock;
  PlayedChip chip{clock};
  std::unique_ptr<GpioPedal> pedal;
};

TEST_F(GpioPedalTest, MakesUpNoEdgeWhereTheTrueOneLiesThereAndItsThreadIsLate) {
  const Instant at = clock.now() + 30ms;
  press_at(at);
  chip.level = EdgeKind::pressed;
  chip.held_up = 300ms;
  pedal->wait(clock.now() + 1s);
  const auto edge = pedal->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->at, at);
  EXPECT_EQ(edge->sequence, 1u);
  EXPECT_FALSE(pedal->take_edge());
}

TEST_F(GpioPedalTest, WakesForAnEdgeAndKeepsItsStamp) {
  const Instant at = clock.now() + 30ms;
  press_at(at);
  pedal->wait(clock.now() + 1s);
  EXPECT_EQ(clock.now(), at);
  chip.level = EdgeKind::pressed;
  const auto edge = pedal->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->at, at);
  EXPECT_EQ(edge->sequence, 1u);
}

TEST_F(GpioPedalTest, EndsAPulseAfterItsWidthWhileItWaits) {
  const Instant began = clock.now();
  ASSERT_TRUE(pedal->pulse_trigger(began, 10ms));
  EXPECT_EQ(chip.trigger, TriggerLevel::raised);
  pedal->wait(began + 5ms);
  EXPECT_EQ(chip.trigger, TriggerLevel::raised);
  pedal->wait(began + 1s);
  EXPECT_EQ(chip.trigger, TriggerLevel::idle);
  EXPECT_EQ(chip.trigger_at, began + 10ms);
}

TEST_F(GpioPedalTest, ProlongsAPulseThatIsStillOn) {
  const Instant began = clock.now();
  ASSERT_TRUE(pedal->pulse_trigger(began, 10ms));
  clock.advance_by(6ms);
  ASSERT_TRUE(pedal->pulse_trigger(clock.now(), 10ms));
  pedal->wait(began + 1s);
  EXPECT_EQ(chip.trigger_at, began + 16ms);
}

TEST_F(GpioPedalTest, LowersTheTriggerWhenItEnds) {
  ASSERT_TRUE(pedal->pulse_trigger(clock.now(), 1s));
  pedal.reset();
  EXPECT_EQ(chip.trigger, TriggerLevel::idle);
  EXPECT_EQ(chip.held, 0);
}

TEST_F(GpioPedalTest, NoticesALostEdgeByTheLevel) {
  chip.level = EdgeKind::pressed;  // and no edge came
  pedal->wait(clock.now() + 1s);
  const auto edge = pedal->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->kind, EdgeKind::pressed);
  EXPECT_EQ(edge->sequence, 2u) << "with a gap, so that nothing is painted for it";
  EXPECT_EQ(pedal->take_edge().error(), PortFault::nothing_yet);
}

TEST_F(GpioPedalTest, SaysDisconnectedAndFindsTheChipAgain) {
  const Instant left = clock.now();
  chip.gone = true;
  pedal->wait(left + 150ms);
  EXPECT_EQ(pedal->take_edge().error(), PortFault::disconnected);
  EXPECT_EQ(chip.held, 0);
  EXPECT_EQ(pedal->pulse_trigger(clock.now(), 1ms).error(), PortFault::disconnected);
  pedal->wait(clock.now() + 1s);
  EXPECT_LE(chip.requests, 7) << "not more often than every 0.2 s";
  chip.gone = false;
  pedal->wait(clock.now() + 300ms);
  EXPECT_EQ(pedal->take_edge().error(), PortFault::nothing_yet);
  press_at(clock.now() + 10ms);
  pedal->wait(clock.now() + 1s);
  chip.level = EdgeKind::pressed;
  const auto edge = pedal->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->sequence, 2u) << "what happened meanwhile nobody knows";
}

TEST_F(GpioPedalTest, SleepsToTheDeadlineWhileTheChipIsGone) {
  chip.gone = true;
  (void)pedal->take_edge();
  const Instant deadline = clock.now() + 30ms;
  pedal->wait(deadline);
  EXPECT_EQ(clock.now(), deadline);
}

TEST_F(GpioPedalTest, RefusesInASentence) {
  chip.gone = true;
  const auto refused = GpioPedal::open({.chip = "gpiochip9", .line = "4"}, clock, chip);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("gpiochip9"), std::string::npos);
  EXPECT_NE(refused.error().message.find("orcart probe"), std::string::npos);
}

TEST_F(GpioPedalTest, AllocatesNothingWhileItRuns) {
  press_at(clock.now() + 10ms);
  EXPECT_TRUE(zero_allocation([&] {
    pedal->wait(clock.now() + 1s);
    (void)pedal->take_edge();
    (void)pedal->pulse_trigger(clock.now(), 1ms);
    pedal->wait(clock.now() + 5ms);
  }));
}

TEST(KernelLines, NamesAnAbsentChip) {
  const auto refused = kernel_lines().request({.chip = "/dev/no-such-chip", .line = "4"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fault, PortFault::disconnected);
}

}  // namespace
}  // namespace orcart::testing
