// Which frame a press means, to the nanosecond.
#include "realtime/sync/capture_selector.hpp"

#include <gtest/gtest.h>

#include "tests/realtime/sync/sync_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::at_ms;
using testing::frame_at;

MatchedFrame good(Instant mid) {
  return {.frame = frame_at(mid), .pose = {}, .refusal = Refusal::none};
}
MatchedFrame bad(Instant mid, Refusal why) {
  return {.frame = frame_at(mid), .pose = {}, .refusal = why};
}

TEST(CaptureSelector, TakesTheFirstFrameWhoseMidExposureIsNotBeforeTheEdge) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 3, .edge_at = at_ms(100)}));
  EXPECT_FALSE(selector.claim(good(at_ms(100) - 1ns)));
  const auto claimed = selector.claim(good(at_ms(100)));
  ASSERT_TRUE(claimed);
  EXPECT_EQ(claimed->unit, 3U);
  EXPECT_FALSE(claimed->streaming);
  EXPECT_FALSE(selector.claim(good(at_ms(133))));
}

TEST(CaptureSelector, PassesOverFramesThatAreNoGood) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  EXPECT_FALSE(selector.claim(bad(at_ms(110), Refusal::tool_unseen)));
  EXPECT_TRUE(selector.claim(good(at_ms(140))));
}

TEST(CaptureSelector, FailsAPressThatFindsNoFrameInItsTime) {
  CaptureSelector selector({.patience = 200ms});
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  EXPECT_FALSE(selector.next_failed(at_ms(299.999)));
  const auto failed = selector.next_failed(at_ms(300));
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->unit, 1U);
  EXPECT_EQ(failed->reason, Refusal::no_frame);
  EXPECT_FALSE(selector.next_failed(at_ms(301)));
  EXPECT_FALSE(selector.claim(good(at_ms(310))));
}

TEST(CaptureSelector, TellsWhyThePressFailed) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  (void)selector.claim(bad(at_ms(90), Refusal::too_late));
  (void)selector.claim(bad(at_ms(110), Refusal::no_pose));
  (void)selector.claim(bad(at_ms(140), Refusal::tool_unseen));
  EXPECT_EQ(selector.next_failed(at_ms(400))->reason, Refusal::tool_unseen);
}

TEST(CaptureSelector, ForgetsACancelledPress) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  EXPECT_FALSE(selector.cancel(2));
  EXPECT_TRUE(selector.cancel(1));
  EXPECT_FALSE(selector.claim(good(at_ms(110))));
  EXPECT_FALSE(selector.next_failed(at_ms(900)));
  EXPECT_FALSE(selector.cancel(1));
}

TEST(CaptureSelector, StreamsEveryFrameUntilTheReleaseWhateverTheOrderOfArrival) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  EXPECT_FALSE(selector.claim(good(at_ms(110)))->streaming);  // the press's own picture
  EXPECT_FALSE(selector.claim(good(at_ms(590))));
  selector.begin_stream({.unit = 1, .edge_at = at_ms(100)});
  for (double ms : {620.0, 650.0, 700.0}) {
    if (ms == 700) selector.end_stream(at_ms(700));
    const auto claimed = selector.claim(good(at_ms(ms)));
    ASSERT_TRUE(claimed) << ms;
    EXPECT_TRUE(claimed->streaming);
    EXPECT_EQ(claimed->unit, 1U);
  }
  EXPECT_FALSE(selector.claim(good(at_ms(700) + 1ns)));
  EXPECT_FALSE(selector.streaming());
}

TEST(CaptureSelector, AsksForMoreGraceWhileAReleaseMayBeOnItsWay) {
  CaptureSelector selector;
  EXPECT_EQ(selector.edge_grace(), 5ms);
  selector.begin_stream({.unit = 1, .edge_at = at_ms(100)});
  EXPECT_EQ(selector.edge_grace(), 25ms);
}

TEST(CaptureSelector, EndsTheStreamOfACancelledUnit) {
  CaptureSelector selector;
  selector.begin_stream({.unit = 4, .edge_at = at_ms(100)});
  EXPECT_TRUE(selector.cancel(4));
  EXPECT_FALSE(selector.claim(good(at_ms(700))));
}

TEST(CaptureSelector, GivesTwoPressesTwoFrames) {
  CaptureSelector selector;
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100)}));
  ASSERT_TRUE(selector.request({.unit = 2, .edge_at = at_ms(101)}));
  EXPECT_EQ(selector.claim(good(at_ms(110)))->unit, 1U);
  EXPECT_EQ(selector.claim(good(at_ms(140)))->unit, 2U);
}

TEST(CaptureSelector, CountsAPressThatComesAfterItsFrameHasGone) {
  CaptureSelector selector;
  EXPECT_FALSE(selector.claim(good(at_ms(100))));
  ASSERT_TRUE(selector.request({.unit = 1, .edge_at = at_ms(100) + 1ns}));
  EXPECT_EQ(selector.late_edges(), 0U);
  ASSERT_TRUE(selector.request({.unit = 2, .edge_at = at_ms(100)}));
  EXPECT_EQ(selector.late_edges(), 1U);
}

TEST(CaptureSelector, RefusesTheNinthPressThatWaits) {
  CaptureSelector selector;
  for (std::uint32_t i = 0; i < CaptureSelector::kMostWaiting; ++i)
    ASSERT_TRUE(selector.request({.unit = i, .edge_at = at_ms(i)}));
  EXPECT_FALSE(selector.request({.unit = 9, .edge_at = at_ms(9)}));
}

TEST(CaptureSelector, AllocatesNothing) {
  CaptureSelector selector;
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 100; ++i) {
      (void)selector.request({.unit = 1, .edge_at = at_ms(i)});
      (void)selector.claim(good(at_ms(i)));
      selector.begin_stream({.unit = 1, .edge_at = at_ms(i)});
      (void)selector.cancel(1);
      (void)selector.next_failed(at_ms(i));
    }
  }));
}

}  // namespace
}  // namespace orcart
