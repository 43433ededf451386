// The clock fit against a device whose clock runs off and whose replies come late, lost and repeated.
#include "realtime/sync/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using Seen = ClockFit::Seen;

constexpr Instant kStart = instant_from_nanos(5'000'000'000);
constexpr double kRate_hz = 60;

/// A device that counts frames from `first`; its replies arrive after an exponential delay on top of
/// `latency`.
class Device {
 public:
  Device(double drift_ppm, std::uint32_t first) : drift_(1 + drift_ppm * 1e-6), first_(first) {}

  std::uint32_t frame(int i) const { return first_ + static_cast<std::uint32_t>(i); }
  Instant measured(int i) const { return kStart + from_seconds(i * drift_ / kRate_hz); }
  Instant arrival(int i) { return measured(i) + kLatency + from_seconds(delay_(random_)); }

  static constexpr Nanos kLatency = 14ms;

 private:
  double drift_;
  std::uint32_t first_;
  std::mt19937 random_{7};
  std::exponential_distribution<double> delay_{1 / 1e-3};  // mean 1 ms
};

ClockFitSettings settings() {
  return {.rate_hz = kRate_hz, .device_latency = Device::kLatency};
}

Nanos error_of(const ClockFit& fit, const Device& device, int i) {
  return fit.host_time(device.frame(i)) - device.measured(i);
}

class ClockFitDrift : public ::testing::TestWithParam<double> {};

TEST_P(ClockFitDrift, IsWithin40MicrosecondsOnceSettledThoughRepliesAreAMillisecondLate) {
  Device device(GetParam(), 1000);
  ClockFit fit(settings());
  Nanos worst{};
  for (int i = 0; i < 60 * kRate_hz; ++i) {
    ASSERT_EQ(fit.observe(device.frame(i), device.arrival(i)), Seen::used);
    EXPECT_FALSE(fit.settled() && i < 2 * kRate_hz);
    EXPECT_TRUE(fit.settled() || i < 2.5 * kRate_hz);
    if (i > 10 * kRate_hz) worst = std::max(worst, std::chrono::abs(error_of(fit, device, i)));
  }
  EXPECT_LT(worst, 40us) << microseconds(worst) << " us";
  EXPECT_NEAR(fit.drift_ppm(), GetParam(), 10);
  RecordProperty("worst_us", std::to_string(microseconds(worst)));
}

INSTANTIATE_TEST_SUITE_P(BothWays, ClockFitDrift, ::testing::Values(-100.0, 0.0, 100.0));

TEST(ClockFit, IsNotPulledByAHundredLateReplies) {
  Device device(50, 0);
  ClockFit fit(settings());
  for (int i = 0; i < 1200; ++i)
    (void)fit.observe(device.frame(i), device.arrival(i) + (i % 12 == 5 ? 80ms : 0ms));
  EXPECT_EQ(fit.restarts(), 0U);
  EXPECT_LT(std::chrono::abs(error_of(fit, device, 1199)), 100us);
}

TEST(ClockFit, DoesNotMindLostFrames) {
  Device device(100, 0);
  ClockFit fit(settings());
  for (int i = 0; i < 1800; ++i)
    if (i % 7 != 0 && (i < 900 || i > 960)) {
      ASSERT_EQ(fit.observe(device.frame(i), device.arrival(i)), Seen::used) << i;
    }
  EXPECT_LT(std::chrono::abs(error_of(fit, device, 1799)), 100us);
}

TEST(ClockFit, CountsOnAcrossTheWrapOfTheFrameNumber) {
  Device device(0, 0xFFFFFFFFU - 600);
  ClockFit fit(settings());
  for (int i = 0; i < 1200; ++i) ASSERT_EQ(fit.observe(device.frame(i), device.arrival(i)), Seen::used) << i;
  EXPECT_LT(std::chrono::abs(error_of(fit, device, 1199)), 100us);
  EXPECT_LT(std::chrono::abs(error_of(fit, device, 590)), 100us);  // a frame before the wrap
}

TEST(ClockFit, SaysThatAFrameIsRepeatedAndLearnsNothingFromIt) {
  Device device(0, 0);
  ClockFit fit(settings());
  for (int i = 0; i < 300; ++i) (void)fit.observe(device.frame(i), device.arrival(i));
  const Instant before = fit.host_time(device.frame(299));
  EXPECT_EQ(fit.observe(device.frame(299), device.arrival(299) + 16ms), Seen::repeated);
  EXPECT_EQ(fit.host_time(device.frame(299)), before);
}

TEST(ClockFit, RestartsWhereTheFrameNumberGoesBack) {
  Device device(0, 5000);
  ClockFit fit(settings());
  for (int i = 0; i < 300; ++i) (void)fit.observe(device.frame(i), device.arrival(i));
  EXPECT_EQ(fit.observe(3, kStart + 6s), Seen::restarted);
  EXPECT_FALSE(fit.settled());
  EXPECT_EQ(fit.restarts(), 1U);
  EXPECT_EQ(fit.host_time(3), kStart + 6s - Device::kLatency);
}

TEST(ClockFit, RestartsWhereTheFrameNumberLeapsAhead) {
  Device device(0, 0);
  ClockFit fit(settings());
  for (int i = 0; i < 300; ++i) (void)fit.observe(device.frame(i), device.arrival(i));
  EXPECT_EQ(fit.observe(device.frame(400), device.arrival(300)), Seen::restarted);
}

TEST(ClockFit, RestartsAtTheEighthReplyInARowThatIsFarTooLateBecauseThenTheCounterStoodStill) {
  Device device(0, 0);
  ClockFit fit(settings());
  for (int i = 0; i < 300; ++i) (void)fit.observe(device.frame(i), device.arrival(i));
  for (int i = 300; i < 307; ++i)
    EXPECT_EQ(fit.observe(device.frame(i), device.arrival(i) + 2s), Seen::used) << i;
  EXPECT_EQ(fit.observe(device.frame(307), device.arrival(307) + 2s), Seen::restarted);
}

TEST(ClockFit, KnowsNothingBeforeTheFirstReply) {
  const ClockFit fit(settings());
  EXPECT_EQ(fit.host_time(17), Instant{});
  EXPECT_FALSE(fit.settled());
}

TEST(ClockFit, AllocatesNothing) {
  Device device(0, 0);
  ClockFit fit(settings());
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 700; ++i) (void)fit.observe(device.frame(i), device.arrival(i));
    (void)fit.host_time(0);
  }));
}

}  // namespace
}  // namespace orcart
