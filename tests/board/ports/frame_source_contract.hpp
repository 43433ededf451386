// What every side of the FrameSource seam must do, written once and run over each of them.
#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "board/ports/frame_source.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// What a side brings to be tested; default-constructible, delivering good frames for a second at least.
class FrameSourceRig {
 public:
  virtual ~FrameSourceRig() = default;
  /// Why there is nothing to test here, e.g. a device that is absent; empty where there is.
  virtual std::string missing() const { return {}; }
  virtual Clock& clock() = 0;
  virtual FrameSource& source() = 0;
  virtual Nanos tolerance() const { return 0ns; }  ///< of wake-ups, stamps and the distance between stamps
  /// Whether the machine may be too slow for every frame; gaps must then show in the stamps as well.
  virtual bool may_lose_frames() const { return false; }
};

template <class Rig>
class FrameSourceContract : public ::testing::Test {
 public:
  Rig rig;

  void SetUp() override {
    if (const std::string missing = rig.missing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  Nanos period() { return period_of(rig.source().format().rate_hz); }
  /// Waits for the next frame, at most five periods.
  Result<FrameBuffer, PortFault> next() {
    rig.source().wait(rig.clock().now() + 5 * period());
    return rig.source().take();
  }
};

TYPED_TEST_SUITE_P(FrameSourceContract);

TYPED_TEST_P(FrameSourceContract, DeliversNothingBeforeItIsStarted) {
  const Instant deadline = this->rig.clock().now() + 3 * this->period();
  this->rig.source().wait(deadline);
  EXPECT_GE(this->rig.clock().now(), deadline);
  const auto frame = this->rig.source().take();
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error(), PortFault::nothing_yet);
}

TYPED_TEST_P(FrameSourceContract, DeliversFramesOfTheFormatItNames) {
  ASSERT_TRUE(this->rig.source().start());
  const auto frame = this->next();
  ASSERT_TRUE(frame);
  const FrameFormat format = this->rig.source().format();
  EXPECT_EQ(frame->image.width_px, format.width_px);
  EXPECT_EQ(frame->image.height_px, format.height_px);
  EXPECT_EQ(frame->image.format, format.format);
  EXPECT_NE(frame->image.planes[0].data, nullptr);
  EXPECT_LT(frame->index, this->rig.source().buffer_count());
}

TYPED_TEST_P(FrameSourceContract, CountsFramesWithoutAGapAndStampsThemAPeriodApart) {
  ASSERT_TRUE(this->rig.source().start());
  auto last = this->next();
  ASSERT_TRUE(last);
  this->rig.source().give_back(last->index);
  for (int i = 0; i < 10; ++i) {
    const auto frame = this->next();
    ASSERT_TRUE(frame);
    const auto steps = frame->sequence - last->sequence;
    EXPECT_GE(steps, 1U);
    EXPECT_TRUE(steps == 1U || this->rig.may_lose_frames()) << steps;
    EXPECT_NEAR(milliseconds(frame->stamp - last->stamp), steps * milliseconds(this->period()),
                milliseconds(this->rig.tolerance()) + 0.001);
    EXPECT_LE(frame->stamp, this->rig.clock().now() + this->rig.tolerance());
    this->rig.source().give_back(frame->index);
    last = frame;
  }
}

TYPED_TEST_P(FrameSourceContract, SaysNothingYetBetweenFrames) {
  ASSERT_TRUE(this->rig.source().start());
  const auto frame = this->next();
  ASSERT_TRUE(frame);
  this->rig.source().give_back(frame->index);
  auto again = this->rig.source().take();
  for (std::uint32_t i = 0; again && i < this->rig.source().buffer_count(); ++i) {  // of a late machine
    this->rig.source().give_back(again->index);
    again = this->rig.source().take();
  }
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error(), PortFault::nothing_yet);
}

TYPED_TEST_P(FrameSourceContract, LendsEachBufferOnceAndLosesFramesWhenNoneIsFree) {
  ASSERT_TRUE(this->rig.source().start());
  std::vector<FrameBuffer> lent;
  std::set<std::uint32_t> names;
  for (std::uint32_t i = 0; i < 2 * this->rig.source().buffer_count(); ++i)
    if (const auto frame = this->next()) {
      EXPECT_TRUE(names.insert(frame->index).second) << "a lent buffer was lent again";
      lent.push_back(*frame);
    }
  ASSERT_FALSE(lent.empty());
  EXPECT_LE(lent.size(), this->rig.source().buffer_count());
  for (const FrameBuffer& frame : lent) this->rig.source().give_back(frame.index);
  const auto after = this->next();
  ASSERT_TRUE(after);
  EXPECT_GT(after->sequence, lent.back().sequence + 1) << "the lost frames must show as a gap";
}

TYPED_TEST_P(FrameSourceContract, StopsAndStartsAgain) {
  ASSERT_TRUE(this->rig.source().start());
  ASSERT_TRUE(this->next());
  this->rig.source().stop();
  EXPECT_FALSE(this->next());
  ASSERT_TRUE(this->rig.source().start());
  EXPECT_TRUE(this->next()) << "a buffer that was lent at stop() is the source's again";
}

REGISTER_TYPED_TEST_SUITE_P(FrameSourceContract, DeliversNothingBeforeItIsStarted,
                            DeliversFramesOfTheFormatItNames,
                            CountsFramesWithoutAGapAndStampsThemAPeriodApart, SaysNothingYetBetweenFrames,
                            LendsEachBufferOnceAndLosesFramesWhenNoneIsFree, StopsAndStartsAgain);

}  // namespace orcart::testing
