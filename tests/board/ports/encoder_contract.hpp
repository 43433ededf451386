// What every side of the TurnEncoder seam must do, written once and run over each of them.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "board/ports/turn_encoder.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// A turn by `counts` more, counted from the rig's start.
struct StepAfter {
  Nanos after{};
  int counts = 0;
};

/// What a side brings to be tested: default-constructible, still until schedule() is called once.
class EncoderRig {
 public:
  virtual ~EncoderRig() = default;
  /// Why there is nothing to test here, e.g. a device that is absent; empty where there is.
  virtual std::string missing() const { return {}; }
  virtual Clock& clock() = 0;
  virtual void schedule(const std::vector<StepAfter>& steps) = 0;
  virtual TurnEncoder& encoder() = 0;              ///< after schedule()
  virtual Nanos tolerance() const { return 0ns; }  ///< of stamps
};

template <class Rig>
class EncoderContract : public ::testing::Test {
 public:
  Rig rig;

  void SetUp() override {
    if (const std::string missing = rig.missing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  /// Takes `count` readings, looking every millisecond; fewer where they do not come within a second.
  std::vector<EncoderReading> take(std::size_t count) {
    std::vector<EncoderReading> readings;
    const Instant end = rig.clock().now() + 1s;
    while (readings.size() < count && rig.clock().now() < end) {
      if (auto reading = rig.encoder().take_reading())
        readings.push_back(*reading);
      else
        rig.clock().sleep_until(rig.clock().now() + 1ms);
    }
    return readings;
  }
};

TYPED_TEST_SUITE_P(EncoderContract);

TYPED_TEST_P(EncoderContract, BeginsWithWhereItStandsAndSaysNothingMoreWhileItStands) {
  const Instant before = this->rig.clock().now();
  this->rig.schedule({});
  const auto first = this->rig.encoder().take_reading();
  ASSERT_TRUE(first);
  EXPECT_GE(first->at, before);
  EXPECT_LE(first->at, this->rig.clock().now());
  EXPECT_EQ(this->rig.encoder().take_reading().error(), PortFault::nothing_yet);
}

TYPED_TEST_P(EncoderContract, CountsBothWaysInOneRunAndStampsEachStepWithItsInstant) {
  const Instant start = this->rig.clock().now();
  this->rig.schedule({{20ms, 4}, {60ms, 1}, {100ms, -7}});
  const auto readings = this->take(4);
  ASSERT_EQ(readings.size(), 4U);
  const std::int64_t from = readings[0].counts;
  EXPECT_EQ(readings[1].counts - from, 4);
  EXPECT_EQ(readings[2].counts - from, 5);
  EXPECT_EQ(readings[3].counts - from, -2);
  for (std::size_t i = 1; i < readings.size(); ++i) {
    EXPECT_EQ(readings[i].run, readings[0].run);
    const Instant due = start + 20ms + 40ms * static_cast<int>(i - 1);
    EXPECT_GE(readings[i].at, due);
    EXPECT_LE(readings[i].at, due + this->rig.tolerance());
  }
}

TYPED_TEST_P(EncoderContract, KeepsStepsThatAreNotTakenAtOnce) {
  this->rig.schedule({{5ms, 1}, {10ms, 1}, {15ms, 1}});
  this->rig.clock().sleep_until(this->rig.clock().now() + 60ms);
  const auto readings = this->take(4);
  ASSERT_EQ(readings.size(), 4U);
  EXPECT_EQ(readings[3].counts - readings[0].counts, 3);
}

REGISTER_TYPED_TEST_SUITE_P(EncoderContract, BeginsWithWhereItStandsAndSaysNothingMoreWhileItStands,
                            CountsBothWaysInOneRunAndStampsEachStepWithItsInstant,
                            KeepsStepsThatAreNotTakenAtOnce);

}  // namespace orcart::testing
