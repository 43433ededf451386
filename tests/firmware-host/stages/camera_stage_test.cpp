// Buffers go out as frames, come home by their lane, and what is wrong with the camera is told.
#include "firmware-host/stages/camera_stage.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "tests/firmware-host/stages/stage_lanes.hpp"

namespace orcart::testing {
namespace {

/// Gives what it was told to give, and remembers what came back.
class ScriptedCamera final : public FrameSource {
 public:
  explicit ScriptedCamera(const Clock& c) : clock(c) {}
  void wait(Instant) noexcept override {}
  Instant next_event() const noexcept override { return Instant::max(); }
  FrameFormat format() const noexcept override { return {}; }
  std::uint32_t buffer_count() const noexcept override { return 8; }
  Result<void, PortFault> start() noexcept override { return {}; }
  void stop() noexcept override {}
  Result<FrameBuffer, PortFault> take() noexcept override {
    if (script.empty()) return tl::unexpected(PortFault::nothing_yet);
    auto next = script.front();
    script.pop_front();
    return next;
  }
  Result<void, PortFault> recover() noexcept override {
    recoveries.push_back(clock.now());
    if (cured) script.clear();
    if (!cured) return tl::unexpected(PortFault::disconnected);
    return {};
  }
  void give_back(std::uint32_t index) noexcept override { home.push_back(index); }

  std::deque<Result<FrameBuffer, PortFault>> script;
  std::vector<std::uint32_t> home;
  const Clock& clock;
  bool cured = false;
  std::vector<Instant> recoveries;
};

class CameraStageTest : public ::testing::Test {
 protected:
  FrameBuffer buffer(std::uint32_t index) const {
    return {.index = index, .sequence = index, .stamp = clock.now() - 6ms + Nanos{index}, .exposure = 8ms};
  }
  CameraNews step() {
    (void)stage.step(clock.now());
    return stage.news();
  }

  SimulatedClock clock;
  ScriptedCamera camera{clock};
  Lanes lanes{small_lanes()};
  CameraStage stage{camera, clock, {.meaning = StampMeaning::end_of_exposure, .exposure = 8ms}, lanes};
};

TEST_F(CameraStageTest, HandsOnAFrameWithItsExposure) {
  camera.script = {buffer(3)};
  (void)step();
  const auto frames = all_of(lanes.frames);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].buffer, 3u);
  EXPECT_EQ(frames[0].exposure_end, clock.now() - 6ms + 3ns);
  EXPECT_EQ(frames[0].exposure_start, frames[0].exposure_end - 8ms);
  EXPECT_EQ(frames[0].dequeued_at, clock.now());
}

TEST_F(CameraStageTest, GivesBackWhatCameHomeBeforeItTakes) {
  ASSERT_TRUE(lanes.frames_home.try_push(5));
  ASSERT_TRUE(lanes.frames_home.try_push(2));
  (void)step();
  EXPECT_EQ(camera.home, (std::vector<std::uint32_t>{5, 2}));
}

TEST_F(CameraStageTest, GivesAFrameBackThatNobodyTakes) {
  Lanes narrow{{.poses = 4, .pedal = 4, .frames = 1, .orders = 4, .patches = 1}};
  CameraStage crowded(camera, clock, {.meaning = StampMeaning::end_of_exposure, .exposure = 8ms}, narrow);
  std::uint32_t index = 0;
  for (; camera.home.empty() && index < 64; ++index) {
    camera.script = {buffer(index % 8)};
    (void)crowded.step(clock.now());
  }
  EXPECT_EQ(camera.home.size(), 1u);
  EXPECT_EQ(all_of(narrow.frames).size(), index - 1);
  EXPECT_EQ(narrow.frames.dropped(), 1u);
}

TEST_F(CameraStageTest, CountsADamagedFrameAndGoesOnToTheNext) {
  camera.script = {tl::unexpected(PortFault::damaged), buffer(1)};
  EXPECT_EQ(step().damaged, 1u);
  EXPECT_EQ(all_of(lanes.frames).size(), 1u);
}

TEST_F(CameraStageTest, TellsOfACameraAllOfWhoseFramesAreDamaged) {
  const Instant began = clock.now();
  for (; clock.now() - began < 1s; clock.advance_by(40ms)) {
    camera.script = {tl::unexpected(PortFault::damaged)};
    (void)step();
    EXPECT_EQ(stage.fault(), PortFault::nothing_yet);
  }
  camera.script = {tl::unexpected(PortFault::damaged)};
  (void)step();
  EXPECT_EQ(stage.fault(), PortFault::damaged);
  EXPECT_TRUE(camera.recoveries.empty()) << "the stream runs";
  camera.script = {buffer(0)};
  (void)step();
  EXPECT_EQ(stage.fault(), PortFault::nothing_yet);
  clock.advance_by(2s);
  camera.script = {tl::unexpected(PortFault::damaged)};
  (void)step();
  EXPECT_EQ(stage.fault(), PortFault::nothing_yet) << "one alone is no news";
}

TEST_F(CameraStageTest, TellsThatTheCameraIsGoneUntilAFrameComes) {
  EXPECT_TRUE(step().connected);
  camera.script = {tl::unexpected(PortFault::disconnected)};
  EXPECT_FALSE(step().connected);
  EXPECT_FALSE(step().connected);
  camera.script = {buffer(0)};
  EXPECT_TRUE(step().connected);
}

TEST_F(CameraStageTest, TellsWrongStampsForWhatTheyAreAndHandsTheFramesOn) {
  for (std::uint32_t i = 0; i < 3; ++i, clock.advance_by(33ms)) {
    FrameBuffer future = buffer(i);
    future.stamp = clock.now() + 1s;
    camera.script = {future};
    (void)step();
  }
  EXPECT_TRUE(stage.news().connected);
  EXPECT_TRUE(stage.news().stamps_wrong);
  EXPECT_EQ(all_of(lanes.frames).size(), 3u);
  camera.script = {buffer(3)};
  EXPECT_FALSE(step().stamps_wrong);
}

TEST_F(CameraStageTest, RecoversAtOnceAndThenLessAndLessOftenButOnceASecond) {
  const Instant broken = clock.now();
  for (int i = 0; i < 4000; ++i, clock.advance_by(1ms)) {
    camera.script = {tl::unexpected(PortFault::io)};
    EXPECT_FALSE(step().connected);
  }
  ASSERT_GE(camera.recoveries.size(), 6u);
  EXPECT_EQ(camera.recoveries[0], broken);
  EXPECT_EQ(camera.recoveries[1] - broken, 100ms);
  EXPECT_EQ(camera.recoveries[2] - broken, 300ms);
  for (std::size_t i = 1; i < camera.recoveries.size(); ++i)
    EXPECT_LE(camera.recoveries[i] - camera.recoveries[i - 1], 1s);
}

TEST_F(CameraStageTest, TakesFramesAgainAfterARecoveryAndBeginsItsBackOffAnew) {
  camera.script = {tl::unexpected(PortFault::io)};
  (void)step();
  clock.advance_by(200ms);
  camera.cured = true;
  camera.script = {tl::unexpected(PortFault::io)};
  (void)step();
  camera.script = {buffer(1)};
  EXPECT_TRUE(step().connected);
  camera.cured = false;
  camera.script = {tl::unexpected(PortFault::timed_out)};
  const std::size_t before = camera.recoveries.size();
  (void)step();
  EXPECT_EQ(camera.recoveries.size(), before + 1);
}

}  // namespace
}  // namespace orcart::testing
