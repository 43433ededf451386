// The two clocks: one goes on by itself, the other only when it is moved.
#include "realtime/kernel/clock.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(RealClock, NeverGoesBack) {
  const RealClock clock;
  const Instant first = clock.now();
  EXPECT_GE(clock.now(), first);
}

TEST(RealClock, IsAwakeNoEarlierThanTheDeadline) {
  RealClock clock;
  const Instant deadline = clock.now() + 200us;
  clock.sleep_until(deadline);
  EXPECT_GE(clock.now(), deadline);
}

TEST(RealClock, DoesNotSleepForADeadlineInThePast) {
  RealClock clock;
  const Instant before = clock.now();
  clock.sleep_until(instant_from_nanos(-1));
  clock.sleep_until(before - 1s);
  EXPECT_LT(clock.now() - before, Nanos{1s});
}

TEST(SimulatedClock, MovesWhenTold) {
  SimulatedClock clock(instant_from_nanos(100));
  clock.advance_by(5ns);
  clock.sleep_until(instant_from_nanos(200));
  EXPECT_EQ(clock.now(), instant_from_nanos(200));
}

TEST(SimulatedClock, NeverGoesBack) {
  SimulatedClock clock(instant_from_nanos(100));
  clock.advance_to(instant_from_nanos(50));
  EXPECT_EQ(clock.now(), instant_from_nanos(100));
}

}  // namespace
}  // namespace orcart
