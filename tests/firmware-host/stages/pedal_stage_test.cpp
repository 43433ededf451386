// From edges on a line to events on a lane, and a trigger pulse for every capture.
#include "firmware-host/stages/pedal_stage.hpp"

#include <gtest/gtest.h>

#include "board/sim/simulated_gpio.hpp"
#include "tests/firmware-host/stages/stage_lanes.hpp"

namespace orcart::testing {
namespace {

constexpr Instant kStart = instant_from_nanos(1'000'000'000);

GpioScript two_presses() {
  return {.edges = {{.at = kStart + 10ms, .kind = EdgeKind::pressed},
                    {.at = kStart + 110ms, .kind = EdgeKind::released},
                    {.at = kStart + 210ms, .kind = EdgeKind::pressed},
                    {.at = kStart + 310ms, .kind = EdgeKind::released}},
          .bounce = {.pairs = 3}};
}

class PedalStageTest : public ::testing::Test {
 protected:
  void run_until(Instant end) {
    for (; clock.now() < end; clock.advance_by(1ms)) (void)stage.step(clock.now());
  }

  SimulatedClock clock{kStart};
  SimulatedGpio lines{clock, two_presses()};
  Lanes lanes{small_lanes()};
  PedalStage stage{lines, PedalSettings{}, lanes};
};

TEST_F(PedalStageTest, ABouncingPressIsOneCaptureStampedAtItsFirstEdge) {
  run_until(kStart + 200ms);
  const auto events = all_of(lanes.pedal);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, PedalEventKind::capture);
  EXPECT_EQ(events[0].at, kStart + 10ms);
  ASSERT_EQ(lines.pulses().size(), 1u);
  EXPECT_GE(lines.pulses()[0].rise, kStart + 10ms);
  EXPECT_LE(lines.pulses()[0].rise, kStart + 11ms);
}

TEST_F(PedalStageTest, ASecondPressTakesBackAndPulsesNothing) {
  run_until(kStart + 500ms);
  const auto events = all_of(lanes.pedal);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[1].kind, PedalEventKind::cancel);
  EXPECT_EQ(events[2].kind, PedalEventKind::undo);
  EXPECT_EQ(lines.pulses().size(), 1u);
}

TEST_F(PedalStageTest, SaysThatThereWasNothingToDo) {
  EXPECT_FALSE(stage.step(clock.now()).worked);
}

}  // namespace
}  // namespace orcart::testing
