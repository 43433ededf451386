// Stage ledgers count what missed its budget, and are judged at the quantile their samples support.
#include "realtime/kernel/budget.hpp"

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

constexpr Budget kBudget{.p999 = 2ms, .bound = 5ms};
constexpr Instant kStart = instant_from_nanos(1'000'000'000);

void record(StageLedger& ledger, Nanos wall, Instant at = kStart) {
  ledger.record({.at = at, .wall = wall, .cpu = wall / 2}, {.worked = true, .items = 3});
}

TEST(StageLedger, CountsStepsOverEachLimit) {
  StageLedger ledger("paint", kBudget);
  record(ledger, 2ms);
  record(ledger, 3ms);
  record(ledger, 5ms);
  record(ledger, 6ms, kStart + 1s);
  EXPECT_EQ(ledger.over_p999(), 3u);
  EXPECT_EQ(ledger.over_bound(), 1u);
  EXPECT_EQ(ledger.last_miss(), kStart + 1s);
  EXPECT_EQ(ledger.items(), 12u);
  EXPECT_EQ(ledger.cpu().snapshot().max(), Nanos{3ms});
}

TEST(StageLedger, WithoutAMissNamesNone) {
  StageLedger ledger("paint", kBudget);
  record(ledger, 1ms);
  EXPECT_FALSE(ledger.last_miss().has_value());
}

TEST(StageLedger, TakesNoSampleOfAStepThatHadNothingToDo) {
  StageLedger ledger("paint", kBudget);
  ledger.record({.at = kStart, .wall = 9ms}, {.worked = false});
  EXPECT_EQ(ledger.wall().count(), 0u);
  EXPECT_EQ(ledger.over_bound(), 0u);
}

TEST(StageLedger, CountsStepsThatCarriedTheRest) {
  StageLedger ledger("map", kBudget);
  ledger.record({.at = kStart, .wall = 1ms}, {.worked = true, .carried = true});
  EXPECT_EQ(ledger.carried(), 1u);
}

TEST(StageLedger, RecordsWithoutAllocating) {
  StageLedger ledger("paint", kBudget);
  EXPECT_TRUE(testing::zero_allocation([&] { record(ledger, 6ms); }));
}

TEST(Judge, AShortRunIsJudgedAtTheQuantileItSupports) {
  StageLedger ledger("paint", kBudget);
  for (int i = 0; i < 10'000; ++i) record(ledger, i < 200 ? Nanos{3ms} : Nanos{1ms});
  const BudgetVerdict verdict = judge(kBudget, ledger.wall().snapshot());
  EXPECT_EQ(verdict.judged_quantile, 0.99);
  EXPECT_FALSE(verdict.within_quantile);  // 2 % took 3 ms, where 2 ms are allowed
  EXPECT_TRUE(verdict.within_bound);
}

TEST(Judge, ATinyRunIsJudgedByItsBoundAlone) {
  StageLedger ledger("paint", kBudget);
  record(ledger, 6ms);
  const BudgetVerdict verdict = judge(kBudget, ledger.wall().snapshot());
  EXPECT_FALSE(verdict.judged_quantile.has_value());
  EXPECT_FALSE(verdict.within_bound);
}

}  // namespace
}  // namespace orcart
