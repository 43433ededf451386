// A thread that could not run is refused with a sentence before it is started.
#include "realtime/kernel/thread_plan.hpp"

#include <array>

#include <gtest/gtest.h>

namespace orcart {
namespace {

ThreadPlan periodic() {
  return {.spec = {.name = "tracker", .rate_hz = 60}, .stages = {}};
}

std::string refusal(const ThreadPlan& plan) {
  const Result<void> checked = check(plan);
  return checked ? std::string() : checked.error().message;
}

TEST(ThreadPlan, WithARateIsAccepted) {
  EXPECT_EQ(refusal(periodic()), "");
}

TEST(ThreadPlan, WithoutRateOrWakeSourceIsRefused) {
  ThreadPlan plan = periodic();
  plan.spec.rate_hz = 0;
  EXPECT_EQ(refusal(plan), "thread 'tracker' has neither a rate nor a wake source; it would never run");
}

TEST(ThreadPlan, WithoutANameIsRefused) {
  ThreadPlan plan = periodic();
  plan.spec.name = {};
  EXPECT_NE(refusal(plan).find("has no name"), std::string::npos);
}

TEST(ThreadPlan, WithAnImpossiblePriorityIsRefused) {
  ThreadPlan plan = periodic();
  plan.spec.fifo_priority = 100;
  EXPECT_EQ(refusal(plan), "thread 'tracker' has fifo_priority 100; 0 (none) to 99 is accepted");
}

TEST(ThreadPlan, WithATinyStackIsRefused) {
  ThreadPlan plan = periodic();
  plan.spec.stack_bytes = 4096;
  EXPECT_NE(refusal(plan).find("stack_bytes 4096"), std::string::npos);
}

TEST(ThreadPlan, WithANullStageIsRefused) {
  ThreadPlan plan = periodic();
  plan.stages = {nullptr};
  EXPECT_NE(refusal(plan).find("null stage"), std::string::npos);
}

TEST(ThreadPlan, WithTheWrongNumberOfLedgersOrCostsIsRefused) {
  StageLedger ledger("x");
  ThreadPlan plan = periodic();
  plan.ledgers = {&ledger};
  EXPECT_NE(refusal(plan).find("1 ledgers for 0 stages"), std::string::npos);
  const std::array costs{Nanos{1ms}};
  plan.ledgers.clear();
  plan.virtual_costs = costs;
  EXPECT_NE(refusal(plan).find("1 virtual costs for 0 stages"), std::string::npos);
}

}  // namespace
}  // namespace orcart
