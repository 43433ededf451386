// A turn that the pictures contradict for a while is noticed; a few pictures, or noise, are not enough.
#include "realtime/sync/turn_check.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart::testing {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

class TurnCheckTest : public ::testing::Test {
 protected:
  /// Pictures 33 ms apart whose notch is `off_deg` further round than what is followed.
  void pictures(int count, double off_deg) {
    for (int i = 0; i < count; ++i, ms += 33) check.compare(at_ms(ms), 0.5, 0.5 + off_deg * kDegree);
  }
  TurnCheck check{2 * kDegree};
  double ms = 0;
};

TEST_F(TurnCheckTest, NoticesASlipWithinHalfASecondAndTellsItsSize) {
  pictures(30, 0.3);
  EXPECT_FALSE(check.differs());
  pictures(11, -5);
  EXPECT_FALSE(check.differs());
  pictures(1, -5);
  EXPECT_TRUE(check.differs());
  EXPECT_NEAR(check.difference_rad(), -5 * kDegree, 1e-9);
}

TEST_F(TurnCheckTest, IsContentAgainOnceThePicturesAre) {
  pictures(15, 5);
  ASSERT_TRUE(check.differs());
  pictures(11, 0);
  EXPECT_TRUE(check.differs());
  pictures(1, 0);
  EXPECT_FALSE(check.differs());
}

TEST_F(TurnCheckTest, IsNotMovedByPicturesThatContradictEachOther) {
  for (int i = 0; i < 20; ++i) {
    pictures(2, 5);
    pictures(1, 0);
  }
  EXPECT_FALSE(check.differs()) << "ten of fifteen";
}

TEST_F(TurnCheckTest, DoesNotAddUpPicturesThatLieFarApart) {
  for (int i = 0; i < 5; ++i) {
    pictures(10, 5);
    ms += 2000;
  }
  EXPECT_FALSE(check.differs());
}

TEST_F(TurnCheckTest, AnAlarmOutlastsAPause) {
  pictures(15, 5);
  ASSERT_TRUE(check.differs());
  ms += 2100;  // withdrawn and wiped
  pictures(11, 5);
  EXPECT_TRUE(check.differs());
  ms += 2100;
  pictures(11, 0);
  EXPECT_TRUE(check.differs());
  pictures(1, 0);
  EXPECT_FALSE(check.differs());
}

TEST_F(TurnCheckTest, TakesTheShortWayRound) {
  for (int i = 0; i < 15; ++i) check.compare(at_ms(33 * i), 3.1, -3.1);
  EXPECT_NEAR(check.difference_rad(), 2 * std::numbers::pi - 6.2, 1e-9);
  EXPECT_TRUE(check.differs());
}

TEST_F(TurnCheckTest, IsSteadyWhereAllPicturesAgree) {
  pictures(14, 40);
  EXPECT_FALSE(check.steady_rad(kDegree));
  pictures(1, 40.5);
  ASSERT_TRUE(check.steady_rad(kDegree));
  EXPECT_NEAR(*check.steady_rad(kDegree), (11 * 40 + 40.5) / 12 * kDegree, 1e-5);
  pictures(1, 43);
  EXPECT_FALSE(check.steady_rad(kDegree));
}

}  // namespace
}  // namespace orcart::testing
