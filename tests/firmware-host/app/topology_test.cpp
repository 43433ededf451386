// The topology table: complete, in order, and its sums are sums.
#include "firmware-host/app/topology.hpp"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(Topology, RowsStandInTheOrderOfTheirIds) {
  for (std::size_t i = 0; i < kStageCount; ++i) EXPECT_EQ(static_cast<std::size_t>(kStages[i].id), i);
  for (std::size_t i = 0; i < kThreadCount; ++i) EXPECT_EQ(static_cast<std::size_t>(kThreads[i].id), i);
}

TEST(Topology, NamesAreUniqueAndFitTheSystem) {
  std::set<std::string_view> names;
  for (const auto& row : kThreads) {
    EXPECT_TRUE(names.insert(row.spec.name).second);
    EXPECT_LE(row.spec.name.size(), 15u);
  }
}

TEST(Topology, EveryBoundIsAtLeastItsPercentile) {
  for (const auto& row : kStages) {
    EXPECT_LE(row.gpu.p999, row.gpu.bound) << row.name;
    EXPECT_LE(row.software.p999, row.software.bound) << row.name;
  }
}

TEST(Topology, TheInputsOutrankWhatTheyFeed) {
  EXPECT_GT(spec_of(ThreadId::tracker).fifo_priority, spec_of(ThreadId::mapping).fifo_priority);
  EXPECT_GT(spec_of(ThreadId::camera).fifo_priority, spec_of(ThreadId::mapping).fifo_priority);
  EXPECT_GT(spec_of(ThreadId::mapping).fifo_priority, spec_of(ThreadId::render).fifo_priority);
  EXPECT_EQ(spec_of(ThreadId::session).fifo_priority, 0);
}

TEST(PathBudget, IsTheSumOfItsStagesAndOfTheWaitsForTheirTurns) {
  // Render: 50 ms of work on a period of 20 ms is a turn every third period, 60 ms; 30 ms one every second.
  const PathBudget software = path_budget(RenderClass::software, 50);
  EXPECT_EQ(software.dequeue_to_submitted.bound, 4ms + 50us + 60ms + 50ms);
  EXPECT_EQ(software.dequeue_to_submitted.p999, 4ms + 20us + 40ms + 30ms);
  EXPECT_EQ(software.dequeue_to_scan_out.bound, software.dequeue_to_submitted.bound + 20ms);
  EXPECT_EQ(software.pedal_to_acknowledged.bound, software.dequeue_to_scan_out.bound + 5ms);
  const PathBudget gpu = path_budget(RenderClass::gpu, 60);
  EXPECT_EQ(gpu.dequeue_to_scan_out.bound, 4ms + 50us + 10ms + 2 * period_of(60));
}

TEST(PathBudget, AGpuAt60HzIsAsFastAsThePedalAsksFor) {
  const PathBudget gpu = path_budget(RenderClass::gpu, 60);
  EXPECT_EQ(gpu.pedal_to_acknowledged.p999, 60ms);
  EXPECT_EQ(gpu.pedal_to_acknowledged.bound, 100ms);
}

TEST(PathBudget, ATurnThatEndsExactlyWhenTheNextIsDueIsInTime) {
  EXPECT_EQ(cycle_of(20ms, 20ms), 20ms);
  EXPECT_EQ(cycle_of(20ms + Nanos{1}, 20ms), 40ms);
  EXPECT_EQ(cycle_of(0ms, 20ms), 20ms);
}

TEST(Topology, QueuesThatMustNotOverflowAreDeepEnough) {
  EXPECT_GE(kFrameQueueDepth, kFrameBuffers);
  EXPECT_GE(kPaintQueueDepth, 2 * kFrameQueueDepth + kPatchSlots + kPedalQueueDepth);
}

}  // namespace
}  // namespace orcart
