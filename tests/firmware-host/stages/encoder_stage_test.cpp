// Every reading is handed on as an angle, in order, and no more is vouched for than was handed on.
#include "firmware-host/stages/encoder_stage.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "tests/firmware-host/stages/stage_lanes.hpp"
#include "tests/realtime/sync/sync_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

struct PlayedEncoder final : TurnEncoder {
  Result<EncoderReading, PortFault> take_reading() noexcept override {
    if (readings.empty()) return tl::unexpected(fault);
    const EncoderReading reading = readings.front();
    readings.pop_front();
    return reading;
  }
  std::deque<EncoderReading> readings;
  PortFault fault = PortFault::nothing_yet;
};

class EncoderStageTest : public ::testing::Test {
 protected:
  EncoderNews news_after(double ms) {
    (void)stage.step(at_ms(ms));
    EncoderNews news;
    EXPECT_TRUE(lanes.encoder_news.take(news));
    return news;
  }

  Lanes lanes{small_lanes()};
  PlayedEncoder encoder;
  EncoderStage stage{encoder, {.rad_per_count = -0.01, .counts_at_zero = 100}, lanes};
};

TEST_F(EncoderStageTest, MakesAnglesOfCounts) {
  encoder.readings = {{at_ms(1), 100, 4}, {at_ms(2), 103, 4}};
  EXPECT_EQ(news_after(5).heard_until, at_ms(5));
  const auto angles = all_of(lanes.encoder_angles);
  ASSERT_EQ(angles.size(), 2u);
  EXPECT_EQ(angles[0].angle_rad, 0);
  EXPECT_NEAR(angles[1].angle_rad, -0.03, 1e-15);
  EXPECT_EQ(angles[1].at, at_ms(2));
  EXPECT_EQ(angles[1].run, 4u);
}

TEST_F(EncoderStageTest, VouchesForNothingSinceTheEncoderIsGone) {
  EXPECT_TRUE(news_after(5).connected);
  encoder.fault = PortFault::disconnected;
  const EncoderNews gone = news_after(10);
  EXPECT_FALSE(gone.connected);
  EXPECT_EQ(gone.heard_until, at_ms(5));
  EXPECT_EQ(stage.fault(), PortFault::disconnected);
  encoder.fault = PortFault::nothing_yet;
  EXPECT_EQ(news_after(15).heard_until, at_ms(15));
  EXPECT_EQ(stage.fault(), PortFault::nothing_yet);
}

TEST_F(EncoderStageTest, KeepsWhatTheLaneCannotTakeAndVouchesForItLater) {
  for (int i = 0; i < 70; ++i) encoder.readings.push_back({at_ms(1), i, 1});
  EXPECT_EQ(news_after(5).heard_until, Instant{}) << "the lane holds 64";
  EXPECT_EQ(all_of(lanes.encoder_angles).size(), 64u);
  EXPECT_EQ(news_after(10).heard_until, at_ms(10));
  const auto rest = all_of(lanes.encoder_angles);
  ASSERT_EQ(rest.size(), 6u);
  EXPECT_NEAR(rest.front().angle_rad, -0.01 * (64 - 100), 1e-12);
}

TEST_F(EncoderStageTest, AllocatesNothing) {
  for (int i = 0; i < 20; ++i) encoder.readings.push_back({at_ms(1), i, 1});
  EXPECT_TRUE(zero_allocation([&] { (void)stage.step(at_ms(5)); }));
}

}  // namespace
}  // namespace orcart::testing
