// The pacer at every kind of overrun: slips and skips exact, phase kept, no sleeping.
#include "realtime/kernel/pacer.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

constexpr Instant kFirst = instant_from_nanos(1'000'000'000);
constexpr Nanos kPeriod = 10ms;

TEST(Pacer, GoesFromPeriodToPeriodWhileTurnsAreShort) {
  Pacer pacer(kPeriod, OverrunPolicy::skip_keep_phase, kFirst);
  for (int turn = 0; turn < 100; ++turn) {
    ASSERT_EQ(pacer.due(), kFirst + turn * kPeriod);
    pacer.turn_over(pacer.due() + 9ms);
  }
  EXPECT_EQ(pacer.slips(), 0u);
  EXPECT_EQ(pacer.turns(), 100u);
}

TEST(Pacer, ATurnThatEndsExactlyAtTheNextIsInTime) {
  Pacer pacer(kPeriod, OverrunPolicy::skip_keep_phase, kFirst);
  EXPECT_EQ(pacer.turn_over(kFirst + kPeriod), 0u);
  EXPECT_EQ(pacer.slips(), 0u);
  EXPECT_EQ(pacer.due(), kFirst + kPeriod);
}

TEST(Pacer, OneNanosecondLaterItHasSlippedAndSkips) {
  Pacer pacer(kPeriod, OverrunPolicy::skip_keep_phase, kFirst);
  EXPECT_EQ(pacer.turn_over(kFirst + kPeriod + 1ns), 1u);
  EXPECT_EQ(pacer.slips(), 1u);
  EXPECT_EQ(pacer.due(), kFirst + 2 * kPeriod);
}

TEST(Pacer, KeepsItsPhaseAfterAnOverrunOfThreeAndAHalfPeriods) {
  Pacer pacer(kPeriod, OverrunPolicy::skip_keep_phase, kFirst);
  EXPECT_EQ(pacer.turn_over(kFirst + 35ms), 3u);  // those due at 10, 20 and 30 ms
  EXPECT_EQ(pacer.due(), kFirst + 40ms);
  EXPECT_EQ(pacer.slips(), 1u);
  EXPECT_EQ(pacer.skipped(), 3u);
}

TEST(Pacer, LandsOnTheGridFromAnyInstant) {
  for (std::int64_t late_ns = 0; late_ns < 100'000'000; late_ns += 777'777) {
    Pacer pacer(kPeriod, OverrunPolicy::skip_keep_phase, kFirst);
    const Instant over = kFirst + Nanos{late_ns};
    const std::uint64_t skipped = pacer.turn_over(over);
    ASSERT_EQ((pacer.due() - kFirst) % kPeriod, Nanos{0});
    ASSERT_GE(pacer.due(), over);
    ASSERT_EQ(pacer.due(), kFirst + static_cast<std::int64_t>(1 + skipped) * kPeriod);
  }
}

TEST(Pacer, RunLateGivesEveryPeriodItsTurn) {
  Pacer pacer(kPeriod, OverrunPolicy::run_late, kFirst);
  Instant now = kFirst + 35ms;
  EXPECT_EQ(pacer.turn_over(now), 0u);
  for (const Nanos due : {10ms, 20ms, 30ms}) {  // back to back, 1 ms each
    EXPECT_EQ(pacer.due(), kFirst + due);
    now += 1ms;
    pacer.turn_over(now);
  }
  EXPECT_EQ(pacer.due(), kFirst + 40ms);
  EXPECT_EQ(pacer.slips(), 3u);  // at 35, 36 and 37 ms the next was past due; at 38 ms that of 40 ms was not
  EXPECT_EQ(pacer.skipped(), 0u);
}

}  // namespace
}  // namespace orcart
