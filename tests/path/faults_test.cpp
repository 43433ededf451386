// What the panel says, and how soon, when a device goes away in the middle of a procedure.
#include <string_view>

#include <gtest/gtest.h>

#include "tests/path/cart_rig.hpp"

namespace orcart::testing {
namespace {

constexpr Nanos kPanelPeriod = 50ms;  // what is known shows with the next picture

RigWish short_run() {
  return {.duration_s = 2.5,
          .camera_hz = 30,
          .script = {.press_every_s = 1.6, .undo_at = -1, .stream_at = -1, .hide_at = -1}};
}

std::string_view notice(const CartRig& rig) {
  return rig.cart->status().notice.text.data();
}

bool video_lost(const Status& status) {
  return status.video == Freshness::lost;
}

TEST(Faults, AnUnpluggedCameraIsToldWithin250Milliseconds) {
  RigWish wish = short_run();
  wish.camera_faults = {{.fault = CameraFault::disconnected, .from = 1500ms, .until = 10s}};
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(1490ms);
  EXPECT_EQ(rig->cart->status().video, Freshness::live);
  EXPECT_LE(rig->until(rig->at(1500ms), video_lost), 250ms);
  EXPECT_TRUE(notice(*rig).starts_with("NO LIVE VIDEO")) << notice(*rig);
}

TEST(Faults, ASilentCameraIsStaleAndThenLost) {
  RigWish wish = short_run();
  wish.camera_faults = {{.fault = CameraFault::off, .from = 1500ms, .until = 10s}};
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(1490ms);
  const Instant last_frame = rig->at(1477'767us);  // end of frame 44: 3.1 ms + 44 / 30 s + 8 ms
  EXPECT_LE(rig->until(last_frame, [](const Status& s) { return s.video == Freshness::stale; }),
            100ms + kPanelPeriod);
  const Nanos lost = rig->until(last_frame, video_lost);
  EXPECT_GE(lost, 250ms);
  EXPECT_LE(lost, 250ms + kPanelPeriod);
  EXPECT_EQ(rig->camera->out(), 1u);
}

TEST(Faults, ASilentTrackerIsLostWithin100MillisecondsAndPaintsNothing) {
  RigWish wish = short_run();
  wish.more_presses = {1700ms};
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig);
  ASSERT_TRUE(rig->devices->tracker_faults().add({.fault = NdiFault::silence, .from = rig->at(1500ms)}));
  ASSERT_TRUE(rig->arm());
  rig->run_until(1490ms);
  EXPECT_EQ(rig->cart->status().tracker, Freshness::live);
  const auto before = rig->painting();
  EXPECT_LE(rig->until(rig->at(1500ms), [](const Status& s) { return s.tracker == Freshness::lost; }),
            100ms + kPanelPeriod);
  EXPECT_TRUE(notice(*rig).starts_with("TRACKER LOST")) << notice(*rig);

  rig->run_to_end();
  const auto& captures = rig->cart->captures();
  ASSERT_EQ(captures.size(), 3u);  // at 1.2, 1.7 and 2.8 s
  EXPECT_EQ(captures.at(0).refusal, Refusal::none);
  EXPECT_NE(captures.at(1).refusal, Refusal::none);
  EXPECT_NE(captures.at(2).refusal, Refusal::none);
  EXPECT_EQ(rig->painting(), before);
}

}  // namespace
}  // namespace orcart::testing
