// Every frame is shown at once; only the one a press means is painted; every other is let go, exactly once.
#include "firmware-host/stages/sync_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/firmware-host/stages/stage_lanes.hpp"
#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart::testing {
namespace {

class SyncStageTest : public ::testing::Test {
 protected:
  /// Poses every 16 ms over a second, arriving 10 ms after they were measured; a frame every 33 ms.
  void run(double until_ms, double hidden_from_ms = 1e9) {
    for (; now_ms_ < until_ms; now_ms_ += 1) {
      const int ms = static_cast<int>(now_ms_);
      if (ms >= 10 && (ms - 10) % 16 == 0) {
        const double measured = now_ms_ - 10;
        (void)lanes.poses.try_push(measured < hidden_from_ms ? sample_at(at_ms(measured))
                                                             : unseen_at(at_ms(measured)));
      }
      if (ms >= 39 && (ms - 39) % 33 == 0)
        (void)lanes.frames.try_push(frame_at(at_ms(now_ms_ - 6), frames_++));
      (void)stage.step(at_ms(now_ms_));
      for (const PaintOrder& order : all_of(lanes.orders)) orders.push_back(order);
      for (const Selection& one : all_of(lanes.selected)) selected.push_back(one);
    }
  }
  void press(double at) {
    (void)lanes.pedal.try_push({.kind = PedalEventKind::capture, .unit = ++unit_, .at = at_ms(at)});
  }
  auto count(PaintOrderKind kind) const { return std::ranges::count(orders, kind, &PaintOrder::kind); }

  Lanes lanes{small_lanes()};
  SyncStage stage{{.history = {.period = 16ms}, .matcher = {}, .selector = {}, .X_MR = {}, .scope = {}},
                  lanes};
  std::vector<PaintOrder> orders;
  std::vector<Selection> selected;

 private:
  double now_ms_ = 0;
  std::uint32_t frames_ = 0, unit_ = 0;
};

TEST_F(SyncStageTest, ShowsAndReleasesEveryFrameThatNobodyWants) {
  run(600);
  EXPECT_EQ(count(PaintOrderKind::show), 17);  // dequeued at 39, 72, ... 567
  EXPECT_GE(count(PaintOrderKind::release), 15);
  EXPECT_TRUE(selected.empty());
}

TEST_F(SyncStageTest, AcknowledgesAPressAndSelectsTheFirstFrameFromItsEdgeOn) {
  run(100);
  press(100);
  run(300);
  EXPECT_EQ(count(PaintOrderKind::acknowledge), 1);
  ASSERT_EQ(selected.size(), 1u);
  EXPECT_EQ(selected[0].matched.frame.mid_exposure(), at_ms(132));  // 33, 66, 99, 132
  EXPECT_EQ(selected[0].request.edge_at, at_ms(100));
  ASSERT_TRUE(selected[0].velocity);
  EXPECT_NEAR((*selected[0].velocity)[0], kSpeed_mm_per_s, 1e-6);
  EXPECT_EQ(count(PaintOrderKind::fail), 0);
  EXPECT_EQ(count(PaintOrderKind::show), count(PaintOrderKind::release) + 1);
}

TEST_F(SyncStageTest, FailsAPressWhileTheToolIsHiddenWithThatReason) {
  run(150, 100);
  press(150);
  run(500, 100);
  EXPECT_TRUE(selected.empty());
  ASSERT_EQ(count(PaintOrderKind::fail), 1);
  const auto failed = std::ranges::find(orders, PaintOrderKind::fail, &PaintOrder::kind);
  EXPECT_EQ(failed->refusal, Refusal::tool_unseen);
  EXPECT_EQ(failed->request.edge_at, at_ms(150));
}

TEST_F(SyncStageTest, FailsAPressThatFindsTooManyWaitingWithThatReason) {
  run(100);
  for (std::size_t i = 0; i <= CaptureSelector::kMostWaiting; ++i) press(100);
  run(101);
  EXPECT_EQ(count(PaintOrderKind::acknowledge), static_cast<std::ptrdiff_t>(CaptureSelector::kMostWaiting));
  ASSERT_EQ(count(PaintOrderKind::fail), 1);
  EXPECT_EQ(std::ranges::find(orders, PaintOrderKind::fail, &PaintOrder::kind)->refusal, Refusal::queue_full);
}

TEST_F(SyncStageTest, TellsWhereTheScopeIsNow) {
  run(200);
  ScopeNow scope;
  ASSERT_TRUE(lanes.scope_now.take(scope));
  EXPECT_EQ(scope.pose.kind, PoseKind::predicted);
  EXPECT_NEAR(scope.X_MC.translation_mm.x(), x_mm_at(at_ms(199)), 1e-6);
}

TEST(SyncStageBlocked, FailsEveryPressAtOnceAndSelectsNothing) {
  Lanes lanes{small_lanes()};
  SyncStage stage{{.history = {.period = 16ms}, .painting_blocked = true}, lanes};
  for (int ms = 0; ms < 200; ++ms) {
    if (ms % 16 == 0) (void)lanes.poses.try_push(sample_at(at_ms(ms)));
    if (ms == 50) (void)lanes.pedal.try_push({.kind = PedalEventKind::capture, .unit = 1, .at = at_ms(50)});
    if (ms % 33 == 0) (void)lanes.frames.try_push(frame_at(at_ms(ms), static_cast<std::uint32_t>(ms / 33)));
    (void)stage.step(at_ms(ms));
  }
  const auto orders = all_of(lanes.orders);
  EXPECT_TRUE(all_of(lanes.selected).empty());
  EXPECT_EQ(std::ranges::count(orders, PaintOrderKind::acknowledge, &PaintOrder::kind), 0);
  EXPECT_EQ(std::ranges::count(orders, PaintOrderKind::show, &PaintOrder::kind), 7);
  const auto failed = std::ranges::find(orders, PaintOrderKind::fail, &PaintOrder::kind);
  ASSERT_NE(failed, orders.end());
  EXPECT_EQ(failed->refusal, Refusal::blocked);
}

/// A scope with its marker on the head and a second one on the light post, which is at `turn_rad` and bent by
/// so much.
Refusal refusal_with(double turn_rad, double bent_rad, double* told_rad = nullptr) {
  ScopeModel scope;
  Turning& turning = scope.turning.emplace();
  turning.marker = TurnMarker::head;
  turning.R_SL.emplace(Eigen::Matrix3d::Identity());
  Lanes lanes{small_lanes()};
  SyncStage stage{{.history = {.period = 16ms, .needs_turn = true},
                   .matcher = {.turn = TurnSource::marker},
                   .scope = scope},
                  lanes};
  for (int ms = 0; ms < 400; ++ms) {
    if (ms % 16 == 0) {
      PoseSample sample = sample_at(at_ms(ms));
      sample.second = ToolState::seen;
      sample.X_TL.rotation = sample.X_TS.rotation *
                             Eigen::AngleAxisd(bent_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                             second_marker_at(*scope.turning, turn_rad);
      (void)lanes.poses.try_push(sample);
    }
    if (ms == 50) (void)lanes.pedal.try_push({.kind = PedalEventKind::capture, .unit = 1, .at = at_ms(50)});
    if (ms % 33 == 0) (void)lanes.frames.try_push(frame_at(at_ms(ms), static_cast<std::uint32_t>(ms / 33)));
    (void)stage.step(at_ms(ms));
    for (const Selection& one : all_of(lanes.selected)) {
      if (told_rad != nullptr) *told_rad = one.matched.turn_rad;
      return one.matched.refusal;
    }
    for (const PaintOrder& order : all_of(lanes.orders))
      if (order.kind == PaintOrderKind::fail) return order.refusal;
  }
  return Refusal::no_frame;
}

/// A press at 150 ms of a scope whose encoder stands at 0.2 rad until 140 ms and at 0.3 from then on, is
/// heard every 5 ms until `gone_ms`, and begins another run at `lost_ms`. Its turn was told as 1 rad at 0.2.
struct EncoderRun {
  double gone_ms = 1e9, lost_ms = 1e9;
  Refusal refusal = Refusal::no_frame;
  double turn_rad = 0;
  TurnLack lack = TurnLack::none;  ///< at the end
};
EncoderRun run_with_encoder(EncoderRun run) {
  Lanes lanes{small_lanes()};
  ScopeModel scope;
  scope.turning.emplace();
  SyncStage stage{{.history = {.period = 16ms, .needs_turn = true},
                   .matcher = {.turn = TurnSource::encoder},
                   .scope = scope,
                   .encoder = {.told_rad = 1}},
                  lanes};
  (void)lanes.encoder_angles.try_push({.at = at_ms(0), .angle_rad = 0.2, .run = 1});
  for (int ms = 0; ms < 600; ++ms) {
    if (ms == 141) (void)lanes.encoder_angles.try_push({.at = at_ms(140), .angle_rad = 0.3, .run = 1});
    if (ms == run.lost_ms) (void)lanes.encoder_angles.try_push({.at = at_ms(ms), .angle_rad = 0, .run = 2});
    if (ms % 5 == 0)
      lanes.encoder_news.post(
          {.heard_until = at_ms(std::min<double>(ms, run.gone_ms)), .connected = ms <= run.gone_ms});
    if (ms % 16 == 0) (void)lanes.poses.try_push(sample_at(at_ms(ms)));
    if (ms == 150) (void)lanes.pedal.try_push({.kind = PedalEventKind::capture, .unit = 1, .at = at_ms(150)});
    if (ms % 33 == 0) (void)lanes.frames.try_push(frame_at(at_ms(ms), static_cast<std::uint32_t>(ms / 33)));
    (void)stage.step(at_ms(ms));
    for (const Selection& one : all_of(lanes.selected)) {
      run.refusal = one.matched.refusal;
      run.turn_rad = one.matched.turn_rad;
    }
    for (const PaintOrder& order : all_of(lanes.orders))
      if (order.kind == PaintOrderKind::fail) run.refusal = order.refusal;
  }
  ScopeNow now;
  if (lanes.scope_now.take(now)) run.lack = now.turn_lack;
  return run;
}

TEST(SyncStageTurn, IsToldByTheEncoderAtTheFramesInstant) {
  const EncoderRun run = run_with_encoder({});
  EXPECT_EQ(run.refusal, Refusal::none);
  EXPECT_NEAR(run.turn_rad, 1.1, 1e-12);
  EXPECT_EQ(run.lack, TurnLack::none);
}

TEST(SyncStageTurn, IsNotKnownWithoutTheEncoderNorAfterItLostItsZero) {
  const EncoderRun gone = run_with_encoder({.gone_ms = 120});
  EXPECT_EQ(gone.refusal, Refusal::turn_unknown);
  EXPECT_EQ(gone.lack, TurnLack::encoder);
  const EncoderRun lost = run_with_encoder({.lost_ms = 145});
  EXPECT_EQ(lost.refusal, Refusal::turn_unknown);
  EXPECT_EQ(lost.lack, TurnLack::encoder_zero);
}

TEST(SyncStageTurn, IsToldByTheSecondMarkerUnlessThatOneWasBent) {
  double told = 0;
  EXPECT_EQ(refusal_with(-1.2, 0, &told), Refusal::none);
  EXPECT_NEAR(told, -1.2, 1e-9);
  EXPECT_EQ(refusal_with(-1.2, 0.07), Refusal::none);
  EXPECT_EQ(refusal_with(-1.2, 0.1), Refusal::turn_unknown);
}

}  // namespace
}  // namespace orcart::testing
