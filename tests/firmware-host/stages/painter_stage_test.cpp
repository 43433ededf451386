// What is taken back and what stays, whatever the order in which paint and pedal reach the painter.
#include "firmware-host/stages/painter_stage.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/stages/stage_lanes.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart::testing {
namespace {

/// A plate 20 mm before the scope, and frames of one colour each.
class PainterStageTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kBuffers = 4;

  PainterStageTest() {
    shared_context();
    for (CutoutPatch& patch : patches_) patch = scenes::whole(wall_, {});
  }

  std::vector<std::uint8_t> painting() { return painter_.read_back().rgba; }

  /// A frame of this grey is shown and painted for `unit`; `seen`: of the surface.
  void paint(std::uint32_t unit, std::uint8_t grey, bool seen = true) {
    pictures_[frames_ % kBuffers] = scenes::flat(scope_, grey, grey, grey);
    const CapturedFrame frame{.buffer = frames_ % kBuffers,
                              .sequence = frames_,
                              .image = pictures_[frames_ % kBuffers].descriptor()};
    const std::uint32_t slot = frames_++ % 4;
    patches_[slot] = seen ? scenes::whole(wall_, {}) : CutoutPatch(1);
    push({.kind = PaintOrderKind::show, .frame = frame});
    push({.kind = PaintOrderKind::paint, .frame = frame, .request = {.unit = unit}, .patch = slot});
  }
  void push(const PaintOrder& order) {
    ASSERT_TRUE(lanes_.orders.try_push(order));
    const Instant began = clock_.now();
    clock_.advance_by(10ms);  // what a step takes
    stage_.step(began);
  }
  /// As a double press does whose first press was `unit`.
  void take_back(std::uint32_t unit) {
    push({.kind = PaintOrderKind::cancel, .request = {.unit = unit}});
    push({.kind = PaintOrderKind::undo, .request = {.unit = unit}});
  }

  const ScopeModel scope_ = scenes::scope();
  const Surface wall_ = scenes::plane(20, 30, 6);
  const AtlasLayout layout_ = *build_atlas(wall_.mesh, {.texel_mm = 0.5});
  Painter painter_ = [this] {
    shared_context();
    return std::move(*Painter::create(wall_, layout_, scope_, {}));
  }();
  SimulatedClock clock_;
  Lanes lanes_{small_lanes()};
  std::vector<CutoutPatch> patches_{4};
  Ledger<CaptureRecord> captures_{64};
  PainterStage stage_{{.painter = painter_,
                       .clock = clock_,
                       .lanes = lanes_,
                       .patches = patches_,
                       .captures = captures_,
                       .buffer_count = kBuffers}};
  std::array<scenes::Rgba, kBuffers> pictures_{};
  std::uint32_t frames_ = 0;
};

TEST_F(PainterStageTest, TakesBackACaptureThatShowedNoSurfaceAndNoOther) {
  paint(1, 60);
  const auto first = painting();
  paint(2, 120);
  paint(3, 180, false);
  EXPECT_EQ(stage_.state().captures, 3u) << "a picture of a board is a capture too";
  take_back(3);
  EXPECT_EQ(painting(), first);
  EXPECT_EQ(stage_.state().captures, 1u);
  ASSERT_EQ(captures_.size(), 3u);
  EXPECT_FALSE(captures_.at(0).undone);
  EXPECT_TRUE(captures_.at(1).undone);
  EXPECT_TRUE(captures_.at(2).undone);
}

TEST_F(PainterStageTest, AStreamOfWhichOnlyAPartShowedTheSurfaceIsTakenBackAsOne) {
  paint(1, 60);
  const auto first = painting();
  paint(2, 100, false);
  paint(2, 120);
  paint(2, 140, false);
  EXPECT_NE(painting(), first);
  push({.kind = PaintOrderKind::undo, .request = {.unit = 2}});
  EXPECT_EQ(painting(), first);
  EXPECT_FALSE(captures_.at(0).undone);
}

TEST_F(PainterStageTest, LetsGoWhatComesOfAUnitThatWasTakenBack) {
  paint(1, 60);
  const auto first = painting();
  paint(2, 120);
  take_back(3);
  EXPECT_EQ(painting(), first);
  paint(2, 140);  // of the stream that was undone
  paint(3, 180);  // of the press that was cancelled
  EXPECT_EQ(painting(), first);
  EXPECT_EQ(stage_.state().captures, 1u);
  EXPECT_EQ(captures_.size(), 2u);
  EXPECT_EQ(all_of(lanes_.frames_home).size(), 3u) << "all buffers but that of the newest picture";
  EXPECT_EQ(all_of(lanes_.patches_home).size(), 4u);
  paint(4, 200);
  EXPECT_NE(painting(), first);
}

TEST_F(PainterStageTest, SaysWhenSomethingIsPaintedNotWhenItsStepBegan) {
  paint(1, 60);
  paint(2, 120);
  EXPECT_EQ(captures_.at(1).painted_at, clock_.now());
  EXPECT_EQ(stage_.state().newest.uploaded_at, clock_.now() - 10ms) << "shown with the order before";
}

TEST_F(PainterStageTest, RefusesAPictureThatIsNotTheScopesAndPaintsNoOtherInItsPlace) {
  paint(1, 60);
  const auto first = painting();
  const FrameRecord shown = stage_.state().newest;
  std::vector<std::byte> pixels(packed_bytes(PixelFormat::rgba8888, 64, 48));
  const CapturedFrame frame{
      .buffer = 1, .sequence = 1, .image = packed_image(pixels.data(), PixelFormat::rgba8888, 64, 48)};
  push({.kind = PaintOrderKind::show, .frame = frame});
  Pose<M, C> X_MC;
  X_MC.translation_mm = {4, 0, 0};
  patches_[1] = scenes::whole(wall_, X_MC);
  push({.kind = PaintOrderKind::paint, .frame = frame, .request = {.unit = 2}, .patch = 1});
  EXPECT_EQ(painting(), first);
  ASSERT_EQ(captures_.size(), 2u);
  EXPECT_EQ(captures_.at(1).refusal, Refusal::no_frame);
  EXPECT_EQ(stage_.state().newest.sequence, shown.sequence) << "the inset shows what it showed";
  EXPECT_EQ(all_of(lanes_.patches_home).size(), 2u);
}

TEST_F(PainterStageTest, OfAHeldPressThatPaintedNothingTheFailureStaysAndNoAcknowledgement) {
  push({.kind = PaintOrderKind::acknowledge, .request = {.unit = 1}});
  push({.kind = PaintOrderKind::fail, .request = {.unit = 1}, .refusal = Refusal::tool_unseen});
  push({.kind = PaintOrderKind::acknowledge, .request = {.unit = 1, .streaming = true}});
  EXPECT_TRUE(stage_.state().acknowledge_pending);
  push({.kind = PaintOrderKind::stream_end, .request = {.unit = 1}});
  EXPECT_FALSE(stage_.state().acknowledge_pending);
  EXPECT_FALSE(stage_.state().streaming);
  EXPECT_EQ(stage_.state().last_refusal, Refusal::tool_unseen);
  EXPECT_EQ(stage_.state().failed_at, clock_.now() - 10ms) << "told as the stream ends";
}

TEST_F(PainterStageTest, OfAStreamThatPaintedAfterAllNoFailureIsTold) {
  push({.kind = PaintOrderKind::fail, .request = {.unit = 1}, .refusal = Refusal::tool_unseen});
  push({.kind = PaintOrderKind::acknowledge, .request = {.unit = 1, .streaming = true}});
  paint(1, 60);
  push({.kind = PaintOrderKind::stream_end, .request = {.unit = 1}});
  EXPECT_EQ(stage_.state().failed_at, Instant{});
}

}  // namespace
}  // namespace orcart::testing
