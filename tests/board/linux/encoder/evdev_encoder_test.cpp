// A rotary encoder over a played evdev device: counted, stamped, its queue overflowing, pulled out and put
// back.
#include "board/linux/encoder/evdev_encoder.hpp"

#include <cerrno>
#include <ctime>

#include <gtest/gtest.h>

#include "tests/board/linux/played_input.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

struct PlayedKnob final : PlayedInput {
  using PlayedInput::PlayedInput;
  int ask(unsigned long request, void* argument) noexcept override {
    auto* bits = static_cast<std::uint8_t*>(argument);
    const auto set = [&](unsigned code) {
      bits[code / 8] = static_cast<std::uint8_t>(bits[code / 8] | 1U << (code % 8));
    };
    if (request == EVIOCGABS(ABS_WHEEL)) {
      if (abs_error == 0) *static_cast<input_absinfo*>(argument) = {.value = stands_at};
      return abs_error;
    }
    if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_REL, 0))) set(REL_DIAL);
    if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) set(ABS_WHEEL);
    return 0;
  }
  void turn(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    event(type, code, value);
    event(EV_SYN, SYN_REPORT, 0);
  }

  int stands_at = 0, abs_error = 0;
};

class EvdevEncoderTest : public ::testing::Test {
 protected:
  std::unique_ptr<EvdevEncoder> opened(const std::string& axis) {
    auto made = EvdevEncoder::open({.device = "/dev/input/event3", .axis = axis}, clock, knob);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : nullptr;
  }
  std::string refusal(const std::string& axis = "rel_dial") {
    const auto made = EvdevEncoder::open({.device = "event3", .axis = axis}, clock, knob);
    return made ? "" : made.error().message;
  }

  SimulatedClock clock;
  PlayedKnob knob{clock};
};

TEST_F(EvdevEncoderTest, GrabsTheKnobAsksForTheMonotonicClockAndBeginsAtNought) {
  auto encoder = opened("rel_dial");
  EXPECT_TRUE(knob.grabbed);
  EXPECT_EQ(knob.clock_id, CLOCK_MONOTONIC);
  const auto first = encoder->take_reading();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->counts, 0);
  EXPECT_EQ(first->at, clock.now());
  EXPECT_EQ(encoder->take_reading().error(), PortFault::nothing_yet);
  encoder.reset();
  EXPECT_EQ(knob.opened, knob.closed);
}

TEST_F(EvdevEncoderTest, AddsTheStepsOfItsAxisAndStampsThemByTheKernel) {
  auto encoder = opened("rel_dial");
  const std::uint32_t run = encoder->take_reading()->run;
  clock.advance_to(clock.now() + 5ms);
  knob.turn(EV_REL, REL_DIAL, 3);
  const Instant stepped = clock.now();
  knob.turn(EV_REL, REL_WHEEL, 7);
  clock.advance_to(clock.now() + 5ms);
  knob.turn(EV_REL, REL_DIAL, -1);
  const auto up = encoder->take_reading(), down = encoder->take_reading();
  ASSERT_TRUE(up && down);
  EXPECT_EQ(up->counts, 3);
  EXPECT_EQ(up->at, stepped);
  EXPECT_EQ(down->counts, 2);
  EXPECT_EQ(down->at, stepped + 5ms);
  EXPECT_EQ(up->run, run);
  EXPECT_EQ(down->run, run);
  EXPECT_EQ(encoder->take_reading().error(), PortFault::nothing_yet);
}

TEST_F(EvdevEncoderTest, MakesOneReadingOfTheEventsOfOneReport) {
  auto encoder = opened("rel_dial");
  (void)encoder->take_reading();
  knob.event(EV_REL, REL_DIAL, 1);
  knob.turn(EV_REL, REL_DIAL, 1);
  EXPECT_EQ(encoder->take_reading()->counts, 2);
  EXPECT_FALSE(encoder->take_reading());
}

TEST_F(EvdevEncoderTest, BeginsANewRunWhereTheKernelDroppedStepsOfARelativeAxis) {
  auto encoder = opened("rel_dial");
  const std::uint32_t run = encoder->take_reading()->run;
  knob.event(EV_SYN, SYN_DROPPED, 0);
  knob.event(EV_REL, REL_DIAL, 5);  // what is left of a report that was cut
  knob.event(EV_SYN, SYN_REPORT, 0);
  knob.turn(EV_REL, REL_DIAL, 2);
  const auto again = encoder->take_reading(), step = encoder->take_reading();
  ASSERT_TRUE(again && step);
  EXPECT_NE(again->run, run);
  EXPECT_EQ(step->run, again->run);
  EXPECT_EQ(step->counts - again->counts, 2);
}

TEST_F(EvdevEncoderTest, AsksAnAbsoluteAxisWhereItStandsAtTheBeginningAndWhereEventsWereDropped) {
  knob.stands_at = 900;
  auto encoder = opened("abs_wheel");
  EXPECT_EQ(encoder->take_reading()->counts, 900);
  knob.turn(EV_ABS, ABS_WHEEL, 901);
  EXPECT_EQ(encoder->take_reading()->counts, 901);
  knob.stands_at = 1000;
  knob.turn(EV_SYN, SYN_DROPPED, 0);
  EXPECT_EQ(encoder->take_reading()->counts, 1000);
}

TEST_F(EvdevEncoderTest, IsPulledOutAndPutBackWithANewRun) {
  auto encoder = opened("rel_dial");
  const std::uint32_t run = encoder->take_reading()->run;
  knob.read_error = -ENODEV;
  knob.open_error = -ENOENT;
  EXPECT_EQ(encoder->take_reading().error(), PortFault::disconnected);
  EXPECT_EQ(knob.opened, knob.closed);
  knob.read_error = knob.open_error = 0;
  EXPECT_EQ(encoder->take_reading().error(), PortFault::disconnected) << "not tried at every call";
  clock.advance_to(clock.now() + EvdevEncoder::kRetry);
  const auto back = encoder->take_reading();
  ASSERT_TRUE(back);
  EXPECT_NE(back->run, run);
  EXPECT_TRUE(knob.grabbed);
}

TEST_F(EvdevEncoderTest, RefusesInASentenceAndLeavesNothingOpen) {
  knob.open_error = -ENOENT;
  EXPECT_NE(refusal().find("encoder /dev/input/event3 cannot be had"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("orcart probe"), std::string::npos) << refusal();
  knob.open_error = -EACCES;
  EXPECT_NE(refusal().find("group input"), std::string::npos) << refusal();
  knob.open_error = 0;
  knob.grab_error = -EBUSY;
  EXPECT_NE(refusal().find("grabbed it"), std::string::npos) << refusal();
  knob.grab_error = 0;
  EXPECT_NE(refusal("rel_x").find("has no axis \"rel_x\"; rel_dial, abs_wheel would be accepted"),
            std::string::npos)
      << refusal("rel_x");
  EXPECT_NE(refusal("dial").find("rel_dial"), std::string::npos) << refusal("dial");
  knob.abs_error = -ENODEV;
  EXPECT_NE(refusal("abs_wheel"), "");
  EXPECT_EQ(knob.opened, knob.closed);
}

TEST_F(EvdevEncoderTest, AllocatesNothingWhileItRuns) {
  auto encoder = opened("rel_dial");
  for (int i = 0; i < 5; ++i) knob.turn(EV_REL, REL_DIAL, 1);
  EXPECT_TRUE(zero_allocation([&] {
    while (encoder->take_reading()) {
    }
  }));
}

}  // namespace
}  // namespace orcart::testing
