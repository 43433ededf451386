// The counter's rate is what two seconds of replies say, not what was assumed.
#include "realtime/sync/counter_rate.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// Feeds `count` frames of a device that measures at `rate_hz` and counts `step` for each; every `late`-th
/// reply comes 15 ms late. How often another rate was found.
int found(CounterRate& counter, double rate_hz, std::uint32_t step, int count, int late = 7) {
  int times = 0;
  for (int i = 0; i < count; ++i) {
    const Nanos delay = i % late == 0 ? 15ms : 2ms;
    times += counter.observe(0xFFFF'FFF0u + static_cast<std::uint32_t>(i) * step,
                             instant_from_nanos(0) + from_seconds(i / rate_hz) + delay)
                 ? 1
                 : 0;
  }
  return times;
}

TEST(CounterRate, FindsThatADeviceCountsThriceForEachFrame) {
  CounterRate counter(20);
  EXPECT_EQ(found(counter, 20, 3, 60), 1);
  EXPECT_EQ(counter.hz(), 60);
}

TEST(CounterRate, FindsThatADeviceKeptARateOfItsOwn) {
  CounterRate counter(100);
  EXPECT_EQ(found(counter, 60, 1, 300), 1);
  EXPECT_EQ(counter.hz(), 60);
}

TEST(CounterRate, KeepsWhatIsTrueWhateverTheDrift) {
  for (const double rate_hz : {60.0, 60.018, 59.982, 45.0, 333.0}) {
    CounterRate counter(std::round(rate_hz));
    EXPECT_EQ(found(counter, rate_hz, 1, static_cast<int>(60 * rate_hz)), 0) << rate_hz;
  }
}

TEST(CounterRate, BelievesNoSecondInWhichTheDeviceWasSilentOrStartedAgain) {
  CounterRate counter(60);
  for (int i = 0; i < 1200; ++i) {
    const auto frame = static_cast<std::uint32_t>(i % 40);  // starts again each 4/3 s
    EXPECT_FALSE(counter.observe(frame, instant_from_nanos(0) + from_seconds(i / 30.0)));
  }
  EXPECT_EQ(counter.hz(), 60);
}

}  // namespace
}  // namespace orcart
