// What a picture's notch says is believed where the neighbours bear it out, and kept only shortly.
#include "realtime/sync/notch_turn.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart::testing {
namespace {

TEST(NotchTurn, IsEachPicturesOwnFromTheSecondOn) {
  NotchTurn turn;
  EXPECT_FALSE(turn.follow(at_ms(0), 0.10)) << "nothing bears out the first";
  EXPECT_EQ(turn.follow(at_ms(33), 0.12), 0.12);
  EXPECT_EQ(turn.follow(at_ms(66), 0.20), 0.20);
  EXPECT_EQ(turn.now(at_ms(90)), 0.20);
}

TEST(NotchTurn, OfAPostThatStandsIsKeptForATenthOfASecond) {
  NotchTurn turn;
  for (const double ms : {0.0, 33.0, 66.0}) (void)turn.follow(at_ms(ms), 0.5);
  EXPECT_EQ(turn.follow(at_ms(99), {}), 0.5);
  EXPECT_EQ(turn.follow(at_ms(166), {}), 0.5);
  EXPECT_FALSE(turn.follow(at_ms(167), {}));
  EXPECT_FALSE(turn.now(at_ms(170)));
}

TEST(NotchTurn, OfAPostThatIsBeingTurnedIsNotKept) {
  NotchTurn turn;
  for (const double ms : {0.0, 33.0, 66.0}) (void)turn.follow(at_ms(ms), 0.5 + 0.0005 * ms);
  EXPECT_FALSE(turn.follow(at_ms(99), {}));
}

TEST(NotchTurn, ThatNoHandCouldReachIsNotBelievedUntilTheNextPictureSaysTheSame) {
  NotchTurn turn;
  for (const double ms : {0.0, 33.0, 66.0}) (void)turn.follow(at_ms(ms), 0.5);
  EXPECT_FALSE(turn.follow(at_ms(99), 2.5)) << "a glitch";
  EXPECT_EQ(turn.follow(at_ms(132), 0.5), 0.5) << "as before";
  EXPECT_FALSE(turn.follow(at_ms(165), 2.5));
  EXPECT_EQ(turn.follow(at_ms(198), 2.5), 2.5) << "twice";
  EXPECT_EQ(turn.follow(at_ms(231), -3.7), -3.7) << "2.58 rad, a whole turn less";
}

TEST(NotchTurn, IsBegunAnewAfterHalfASecondWithoutANotch) {
  NotchTurn turn;
  for (const double ms : {0.0, 33.0}) (void)turn.follow(at_ms(ms), 0.5);
  EXPECT_FALSE(turn.follow(at_ms(600), 0.5));
  EXPECT_EQ(turn.follow(at_ms(633), 0.5), 0.5);
}

TEST(NotchTurn, IsNotShownOnceThePicturesHaveStopped) {
  NotchTurn turn;
  for (const double ms : {0.0, 33.0}) (void)turn.follow(at_ms(ms), 0.5);
  EXPECT_TRUE(turn.now(at_ms(280)));
  EXPECT_FALSE(turn.now(at_ms(284)));
}

}  // namespace
}  // namespace orcart::testing
