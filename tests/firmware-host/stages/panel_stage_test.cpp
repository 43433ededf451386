// What the panel says of its sources and of the machine.
#include "firmware-host/stages/panel_stage.hpp"

#include <gtest/gtest.h>

#include "board/sim/simulated_panel.hpp"
#include "tests/firmware-host/stages/stage_lanes.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart::testing {
namespace {

/// Loses captures as it is told.
class LossySink final : public CaptureSink {
 public:
  void keep(const CapturedFrame&, const CaptureRecord&) noexcept override {}
  void undone(std::uint32_t) noexcept override {}
  std::uint64_t lost() const noexcept override { return count; }
  bool failing() const noexcept override { return fails; }

  std::uint64_t count = 0;
  bool fails = false;
};

/// A small panel over a plate; tracker at 60 Hz, video at 30.
class PanelStageTest : public ::testing::Test {
 protected:
  static constexpr PanelMode kMode{.width_px = 320, .height_px = 200, .refresh_hz = 30};

  /// A picture that was exposed until then is shown from now on.
  void show(Instant exposed) { show(exposed, exposed); }
  void show(Instant exposed, Instant dequeued) {
    const CapturedFrame frame{.sequence = ++frames_shown_,
                              .image = picture_.descriptor(),
                              .exposure_start = exposed - 8ms,
                              .exposure_end = exposed,
                              .dequeued_at = dequeued};
    ASSERT_TRUE(lanes_.orders.try_push({.kind = PaintOrderKind::show, .frame = frame}));
    painting_.step(dequeued);
  }

  const Status& status_at(Nanos step, Nanos clock) {
    clock_.advance_to(instant_from_nanos(clock.count()));
    stage_.step(instant_from_nanos(step.count()));
    return stage_.status();
  }

  const ScopeModel scope_ = scenes::scope();
  const Surface wall_ = scenes::plane(20, 30, 6);
  const AtlasLayout layout_ = *build_atlas(wall_.mesh, {.texel_mm = 0.5});
  Painter painter_ = [this] {
    shared_context();
    return std::move(*Painter::create(wall_, layout_, scope_, {}));
  }();
  Screen screen_ = std::move(
      *Screen::create(wall_, layout_, scope_, {.width_px = kMode.width_px, .height_px = kMode.height_px}));
  scenes::Rgba picture_ = scenes::flat(scope_, 90, 90, 90);
  std::uint32_t frames_shown_ = 0;
  SimulatedClock clock_;
  SimulatedPanel panel_{clock_, {.mode = kMode}};
  Lanes lanes_{small_lanes()};
  std::vector<CutoutPatch> patches_{1};
  Ledger<FrameRecord> frames_{16};
  Ledger<CaptureRecord> captures_{16};
  PainterStage painting_{{.painter = painter_,
                          .clock = clock_,
                          .lanes = lanes_,
                          .patches = patches_,
                          .captures = captures_,
                          .buffer_count = 1}};
  LossySink sink_;
  PanelStage::Parts parts_on(Panel& panel) {
    return {.panel = panel,
            .screen = screen_,
            .painter = painter_,
            .painter_stage = painting_,
            .clock = clock_,
            .lanes = lanes_,
            .frames = frames_,
            .captures = captures_,
            .sink = &sink_};
  }
  PanelStage stage_{parts_on(panel_),
                    {.eye = eye_on(wall_.mesh, {0, 0, -1}, {0, -1, 0}),
                     .freshness = {.tracker_period = 16ms, .video_period = 33ms}}};
};

TEST_F(PanelStageTest, WhatCannotBeDrawnIntoIsAFaultAndNotShown) {
  SimulatedPanel larger(clock_, {.mode = {.width_px = 400, .height_px = 300, .refresh_hz = 30}});
  PanelStage stage(parts_on(larger), {.eye = eye_on(wall_.mesh, {0, 0, -1}, {0, -1, 0})});
  stage.step(instant_from_nanos(Nanos{100ms}.count()));
  EXPECT_EQ(stage.fault(), PortFault::unsupported);
  EXPECT_EQ(stage.presented(), 0u);
}

TEST_F(PanelStageTest, ATrackerThatRefusesIsNoMatterOfItsCable) {
  const Instant came = instant_from_nanos(Nanos{2003ms}.count());
  show(came);
  lanes_.tracker_news.post({.refuses = true});
  EXPECT_EQ(std::string_view(status_at(2000ms, 2004ms).notice.text.data()), "TRACKER REFUSES: see the log");
  lanes_.tracker_news.post({});
  EXPECT_EQ(std::string_view(status_at(2010ms, 2014ms).notice.text.data()), "TRACKER LOST: check its cable");
}

TEST_F(PanelStageTest, WhatCameSinceTheStepBeganIsLive) {
  const Instant came = instant_from_nanos(Nanos{2003ms}.count());
  lanes_.tracker_news.post({.last_reply = came, .last_complete = came});
  show(came);
  const Status& status = status_at(2000ms, 2004ms);
  EXPECT_EQ(status.tracker, Freshness::live);
  EXPECT_EQ(status.video, Freshness::live);
  EXPECT_TRUE(status.tool_seen);
  EXPECT_EQ(status_at(2200ms, 2200ms).tracker, Freshness::lost);
}

TEST_F(PanelStageTest, ALivePictureKeepsUpWithWhatTheCameraSends) {
  const auto at = [](Nanos since) { return instant_from_nanos(since.count()); };
  show(at(2000ms));
  for (const auto& [now, video] :
       {std::pair(Nanos{2090ms}, Freshness::live), {2160ms, Freshness::stale}, {2260ms, Freshness::lost}}) {
    lanes_.camera_news.post({.last_frame = at(now)});
    EXPECT_EQ(status_at(now, now).video, video) << now.count();
  }
  show(at(2290ms));
  EXPECT_EQ(status_at(2300ms, 2300ms).video, Freshness::live);
  EXPECT_EQ(status_at(2400ms, 2400ms).video, Freshness::stale) << "the camera sends none";
}

TEST_F(PanelStageTest, OfWrongStampsThePictureStaysAndTheNoticeNamesThem) {
  const auto at = [](Nanos since) { return instant_from_nanos(since.count()); };
  show(at(3000ms), at(2000ms));
  lanes_.camera_news.post({.last_frame = at(3000ms), .last_dequeued = at(2000ms), .stamps_wrong = true});
  lanes_.tracker_news.post({.last_reply = at(2000ms), .last_complete = at(2000ms)});
  const Status& status = status_at(2010ms, 2010ms);
  EXPECT_EQ(status.video, Freshness::live);
  EXPECT_STREQ(status.notice.text.data(), "CAMERA STAMPS WRONG: see [camera] stamp");
  EXPECT_EQ(status_at(2300ms, 2300ms).video, Freshness::lost) << "none came since";
}

TEST_F(PanelStageTest, SaysDegradedOnceItWasTold) {
  EXPECT_FALSE(status_at(2000ms, 2000ms).degraded);
  stage_.tell_degraded();
  EXPECT_TRUE(status_at(2200ms, 2200ms).degraded);
}

TEST_F(PanelStageTest, SaysThatCapturesAreNotKeptWhileWritesFailAndAWhileAfterEachLoss) {
  constexpr const char* kNotKept = "SESSION NOT KEPT: the disk is full or too slow";
  const auto notice_at = [&](Nanos at) {
    const Instant now = instant_from_nanos(at.count());
    lanes_.tracker_news.post({.last_reply = now, .last_complete = now});
    show(now);
    const Notice& notice = status_at(at, at).notice;
    return notice.level == Notice::Level::none ? std::string() : std::string(notice.text.data());
  };
  EXPECT_EQ(notice_at(1s), "");
  sink_.count = 1;
  EXPECT_EQ(notice_at(2s), kNotKept);
  EXPECT_EQ(notice_at(31s), kNotKept);
  EXPECT_EQ(notice_at(33s), "");
  sink_.fails = true;
  EXPECT_EQ(notice_at(34s), kNotKept);
  EXPECT_EQ(notice_at(99s), kNotKept);
}

}  // namespace
}  // namespace orcart::testing
