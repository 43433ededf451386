// What an encoder tells of the turn at an instant, and of which instants it tells nothing.
#include "realtime/sync/encoder_turn.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart::testing {
namespace {

/// Stood at 0 since 0 ms, at 0.1 rad from 100 ms on, heard until 200 ms; told 1 rad at its start.
EncoderTurn turned_once(const EncoderTurnSettings& settings = {.told_rad = 1}) {
  EncoderTurn turn(settings);
  turn.push({.at = at_ms(0), .angle_rad = 0, .run = 1});
  turn.push({.at = at_ms(100), .angle_rad = 0.1, .run = 1});
  turn.heard(at_ms(200), true);
  return turn;
}

TEST(EncoderTurn, TellsTheTurnThatTheEncoderStoodAtThen) {
  const EncoderTurn turn = turned_once();
  EXPECT_FALSE(turn.at(at_ms(-1)));
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(0)), 1);
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(99)), 1);
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(100)), 1.1);
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(200)), 1.1) << "it stands until it turns";
}

TEST(EncoderTurn, TellsNothingOfWhatWasNotHeardYet) {
  EncoderTurn turn = turned_once();
  EXPECT_FALSE(turn.at(at_ms(201)));
  EXPECT_FALSE(turn.decided(at_ms(201)));
  EXPECT_TRUE(turn.decided(at_ms(200)));
  turn.heard(at_ms(210), true);
  EXPECT_TRUE(turn.at(at_ms(201)));
}

TEST(EncoderTurn, TellsNothingWhileTheEncoderIsGone) {
  EncoderTurn turn = turned_once();
  turn.heard(at_ms(200), false);
  EXPECT_FALSE(turn.connected());
  EXPECT_TRUE(turn.decided(at_ms(300))) << "nobody need wait";
  EXPECT_FALSE(turn.at(at_ms(300)));
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(150)), 1.1) << "what was heard before stays true";
}

TEST(EncoderTurn, LosesItsZeroWithItsRunAndTellsNothingAcrossTheLoss) {
  EncoderTurn turn = turned_once();
  EXPECT_TRUE(turn.zero_known());
  turn.push({.at = at_ms(250), .angle_rad = 0, .run = 2});
  turn.heard(at_ms(300), true);
  EXPECT_FALSE(turn.zero_known());
  EXPECT_FALSE(turn.at(at_ms(260)));
  EXPECT_FALSE(turn.at(at_ms(150))) << "steps may have been lost since the reading at 100 ms";
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(50)), 1);
}

TEST(EncoderTurn, HasNoZeroWhereNobodyToldIt) {
  const EncoderTurn turn = turned_once({});
  EXPECT_FALSE(turn.zero_known());
  EXPECT_FALSE(turn.at(at_ms(150)));
}

TEST(EncoderTurn, KnowsTheTurnOfAnAbsoluteEncoderInEveryRun) {
  EncoderTurn turn = turned_once({.absolute = true});
  EXPECT_DOUBLE_EQ(*turn.at(at_ms(150)), 0.1);
  turn.push({.at = at_ms(250), .angle_rad = 7, .run = 2});
  turn.heard(at_ms(300), true);
  EXPECT_TRUE(turn.zero_known());
  EXPECT_NEAR(*turn.at(at_ms(260)), 7 - 2 * std::numbers::pi, 1e-12);
  EXPECT_FALSE(turn.at(at_ms(240)));
}

TEST(EncoderTurn, GoesRoundMoreThanOnce) {
  EncoderTurn turn = turned_once();
  turn.push({.at = at_ms(210), .angle_rad = 6 * std::numbers::pi, .run = 1});
  turn.heard(at_ms(300), true);
  EXPECT_NEAR(*turn.at(at_ms(300)), 1, 1e-12);
}

TEST(EncoderTurn, KeepsHalfASecondOfAFastEncoderToAMillisecond) {
  EncoderTurn turn({.told_rad = 0});
  for (int i = 0; i <= 20'000; ++i)  // 20 kHz for a second, 1e-4 rad a step
    turn.push({.at = at_ms(0.05 * i), .angle_rad = 1e-4 * i, .run = 1});
  turn.heard(at_ms(1000), true);
  for (int ms = 520; ms <= 1000; ms += 7) {
    const auto at = turn.at(at_ms(ms));
    ASSERT_TRUE(at) << ms;
    EXPECT_NEAR(*at, 2e-3 * ms, 2.1e-3) << ms;
  }
}

}  // namespace
}  // namespace orcart::testing
