// A step over its bound is told once, by its stage's name, with whose fault it was.
#include "firmware-host/app/budget_log.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

class BudgetLogTest : public ::testing::Test {
 protected:
  void step(StageId id, Nanos wall, Nanos cpu) {
    ledgers[static_cast<std::size_t>(id)].record({.at = now, .wall = wall, .cpu = cpu}, {.worked = true});
  }
  static StageLedger one(StageId id) { return StageLedger(row_of(id).name, budget_of(id, RenderClass::gpu)); }

  std::array<StageLedger, kStageCount> ledgers{
      one(StageId::pedal),  one(StageId::tracker), one(StageId::camera), one(StageId::sync),
      one(StageId::mapper), one(StageId::painter), one(StageId::panel),  one(StageId::session)};
  BudgetLog log;
  Instant now = instant_from_nanos(1'000'000'000);
};

TEST_F(BudgetLogTest, IsSilentWhileEveryStageKeepsItsBound) {
  step(StageId::mapper, 3ms, 3ms);
  EXPECT_TRUE(log.news(ledgers, now).empty());
}

TEST_F(BudgetLogTest, NamesTheStageItsThreadAndHowMuchOfItTheThreadItselfRan) {
  step(StageId::mapper, 12ms, 1ms);
  const auto lines = log.news(ledgers, now);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("stage \"mapper\" (thread mapping)"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("bound of 3 ms 1 times, 1 of them new; longest 12.000 ms"), std::string::npos)
      << lines[0];
  EXPECT_NE(lines[0].find("at most 1.000 ms"), std::string::npos) << lines[0];
  EXPECT_TRUE(log.news(ledgers, now + 5s).empty());
}

TEST_F(BudgetLogTest, TellsAStageThatKeepsMissingOnceASecond) {
  int told = 0;
  for (int i = 0; i < 300; ++i, now += 10ms) {
    step(StageId::panel, 6ms, 6ms);
    told += static_cast<int>(log.news(ledgers, now).size());
  }
  EXPECT_EQ(told, 3);
}

}  // namespace
}  // namespace orcart
