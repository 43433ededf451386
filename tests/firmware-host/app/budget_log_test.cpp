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
      one(StageId::pedal),   one(StageId::encoder), one(StageId::tracker),
      one(StageId::camera),  one(StageId::sync),    one(StageId::mapper),
      one(StageId::painter), one(StageId::panel),   one(StageId::session)};
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

TEST_F(BudgetLogTest, TellsAStageThatKeepsMissingEverMoreSeldomButToldOfAll) {
  std::vector<int> told_at_s;
  for (int i = 0; i < 6000; ++i, now += 100ms) {
    step(StageId::panel, 6ms, 6ms);
    if (!log.news(ledgers, now).empty()) told_at_s.push_back(i / 10);
  }
  EXPECT_EQ(told_at_s, (std::vector{0, 1, 3, 7, 15, 31, 63, 127, 191, 255, 319, 383, 447, 511, 575}));
  now += 64s;
  const auto last = log.news(ledgers, now);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_NE(last[0].find("6000 times"), std::string::npos) << last[0];
}

}  // namespace
}  // namespace orcart
