// The words for time: conversions are exact where they can be and rounded to the nearest nanosecond
// elsewhere.
#include "realtime/base/instant.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Instant, RoundTripsThroughNanoseconds) {
  EXPECT_EQ(nanos_since_zero(instant_from_nanos(1'234'567'890'123)), 1'234'567'890'123);
}

TEST(Instant, DifferencesAreNanos) {
  EXPECT_EQ(instant_from_nanos(5'000'000) - instant_from_nanos(2'000'000), Nanos{3ms});
}

TEST(Nanos, ReadAsSecondsMillisecondsAndMicroseconds) {
  EXPECT_DOUBLE_EQ(seconds(1500ms), 1.5);
  EXPECT_DOUBLE_EQ(milliseconds(1500us), 1.5);
  EXPECT_DOUBLE_EQ(microseconds(1500ns), 1.5);
}

TEST(Nanos, FromSecondsRoundsToTheNearestEitherSideOfZero) {
  EXPECT_EQ(from_seconds(1.6e-9), Nanos{2});
  EXPECT_EQ(from_seconds(-1.6e-9), Nanos{-2});
  EXPECT_EQ(from_seconds(0.25), Nanos{250ms});
}

TEST(Nanos, PeriodOfARateIsRoundedToTheNanosecond) {
  EXPECT_EQ(period_of(60.0), Nanos{16'666'667});
  EXPECT_EQ(period_of(1000.0), Nanos{1ms});
}

}  // namespace
}  // namespace orcart
