// What every side of the GpioLines seam must do, written once and run over each of them.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "board/ports/gpio_lines.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// One edge to come, counted from the rig's start.
struct EdgeAfter {
  Nanos after{};
  EdgeKind kind = EdgeKind::pressed;
};

/// What a side brings to be tested: default-constructible, without input until schedule() is called once.
class GpioRig {
 public:
  virtual ~GpioRig() = default;
  /// Why there is nothing to test here, e.g. a device that is absent; empty where there is.
  virtual std::string missing() const { return {}; }
  virtual Clock& clock() = 0;
  virtual void schedule(const std::vector<EdgeAfter>& edges) = 0;
  virtual GpioLines& lines() = 0;                  ///< after schedule()
  virtual Nanos tolerance() const { return 0ns; }  ///< of stamps and wake-ups
};

template <class Rig>
class GpioContract : public ::testing::Test {
 public:
  Rig rig;

  void SetUp() override {
    if (const std::string missing = rig.missing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  /// Waits for and takes `count` edges, as a pedal thread does; fewer where they do not come within a second.
  std::vector<PedalEdge> take(std::size_t count) {
    std::vector<PedalEdge> edges;
    const Instant end = rig.clock().now() + 1s;
    while (edges.size() < count && rig.clock().now() < end) {
      rig.lines().wait(end);
      if (auto edge = rig.lines().take_edge()) edges.push_back(*edge);
    }
    return edges;
  }
};

TYPED_TEST_SUITE_P(GpioContract);

TYPED_TEST_P(GpioContract, SaysNothingYetWhereNoEdgeHasCome) {
  this->rig.schedule({});
  const auto edge = this->rig.lines().take_edge();
  ASSERT_FALSE(edge);
  EXPECT_EQ(edge.error(), PortFault::nothing_yet);
}

TYPED_TEST_P(GpioContract, WaitsNoLongerThanTheDeadline) {
  this->rig.schedule({});
  const Instant deadline = this->rig.clock().now() + 30ms;
  this->rig.lines().wait(deadline);
  EXPECT_GE(this->rig.clock().now(), deadline);
  EXPECT_LE(this->rig.clock().now(), deadline + this->rig.tolerance());
}

TYPED_TEST_P(GpioContract, WakesForAnEdgeAndStampsItWithItsInstant) {
  const Instant start = this->rig.clock().now();
  this->rig.schedule({{20ms, EdgeKind::pressed}});
  const auto edges = this->take(1);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].kind, EdgeKind::pressed);
  EXPECT_GE(edges[0].at, start + 20ms);
  EXPECT_LE(edges[0].at, start + 20ms + this->rig.tolerance());
  EXPECT_LE(this->rig.clock().now(), start + 20ms + 2 * this->rig.tolerance());
}

TYPED_TEST_P(GpioContract, GivesEdgesInOrderAndCountsThemWithoutAGap) {
  this->rig.schedule({{10ms, EdgeKind::pressed}, {30ms, EdgeKind::released}, {50ms, EdgeKind::pressed}});
  const auto edges = this->take(3);
  ASSERT_EQ(edges.size(), 3U);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    EXPECT_EQ(edges[i].sequence, edges[i - 1].sequence + 1);
    EXPECT_LT(edges[i - 1].at, edges[i].at);
    EXPECT_NE(edges[i].kind, edges[i - 1].kind);
  }
}

TYPED_TEST_P(GpioContract, KeepsEdgesThatAreNotTakenAtOnce) {
  this->rig.schedule({{5ms, EdgeKind::pressed}, {10ms, EdgeKind::released}});
  this->rig.clock().sleep_until(this->rig.clock().now() + 40ms);
  EXPECT_EQ(this->take(2).size(), 2U);
}

TYPED_TEST_P(GpioContract, PulsesTheTriggerWithoutWaitingForItsEnd) {
  this->rig.schedule({});
  const Instant before = this->rig.clock().now();
  EXPECT_TRUE(this->rig.lines().pulse_trigger(before, 100ms));
  EXPECT_LE(this->rig.clock().now(), before + this->rig.tolerance());
}

REGISTER_TYPED_TEST_SUITE_P(GpioContract, SaysNothingYetWhereNoEdgeHasCome, WaitsNoLongerThanTheDeadline,
                            WakesForAnEdgeAndStampsItWithItsInstant,
                            GivesEdgesInOrderAndCountsThemWithoutAGap, KeepsEdgesThatAreNotTakenAtOnce,
                            PulsesTheTriggerWithoutWaitingForItsEnd);

}  // namespace orcart::testing
