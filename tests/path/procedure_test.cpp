// A short procedure from the pedal to the painting: which frame a press means, what is taken back, what is
// refused, and all of it the same every time.
#include <tuple>

#include <gtest/gtest.h>

#include "board/sim/exposure_timing.hpp"
#include "tests/path/cart_rig.hpp"

namespace orcart::testing {
namespace {

auto fields(const FrameRecord& f) {
  return std::tuple(f.sequence, f.mid_exposure, f.dequeued_at, f.uploaded_at, f.submitted_at, f.scan_out_at,
                    f.late);
}

auto fields(const CaptureRecord& c) {
  return std::tuple(c.unit, c.frame_sequence, c.streaming, c.refusal, c.edge_at, c.acknowledged_at,
                    c.mid_exposure, c.matched_at, c.mapped_at, c.painted_at, c.on_panel_at, c.pose_kind,
                    c.pose_distance, c.undone);
}

template <class Record>
void expect_same(const Ledger<Record>& one, const Ledger<Record>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(fields(one.at(i)), fields(other.at(i))) << i;
}

std::unique_ptr<CartRig> finished(const RigWish& wish) {
  auto rig = CartRig::create(wish);
  if (!rig || !rig->arm()) return nullptr;
  rig->run_to_end();
  return rig;
}

/// Of the exposures that the movie was drawn by, the first whose middle is not before `edge`.
Instant first_middle_from(const CartRig& rig, Instant edge) {
  const ExposureTiming timing{.rate_hz = rig.config.camera.rate_hz,
                              .exposure = from_seconds(rig.config.camera.exposure_ms * 1e-3)};
  std::uint64_t frame = 0;
  while (rig.at(timing.middle_of(frame)) < edge) ++frame;
  return rig.at(timing.middle_of(frame));
}

TEST(Procedure, IsTheSameToTheBitEveryTime) {
  const auto one = finished(presses()), other = finished(presses());
  ASSERT_TRUE(one && other);
  EXPECT_GT(one->cart->captures().size(), 0u);
  expect_same(one->cart->frames(), other->cart->frames());
  expect_same(one->cart->captures(), other->cart->captures());
  for (std::size_t i = 0; i < one->cart->captures().size(); ++i) {
    const Pose<M, C>&a = one->cart->captures().at(i).X_MC, &b = other->cart->captures().at(i).X_MC;
    EXPECT_TRUE(a.rotation == b.rotation && a.translation_mm == b.translation_mm) << i;
  }
  EXPECT_EQ(one->painting(), other->painting());
}

TEST(Procedure, PaintsEachPressWithTheFirstFrameFromItsEdgeOn) {
  const auto rig = finished(presses());
  ASSERT_TRUE(rig);
  const auto& captures = rig->cart->captures();
  ASSERT_EQ(captures.size(), 4u);
  const Instant edges[] = {rig->at(1200ms), rig->at(2800ms), rig->at(4400ms)};
  for (std::size_t i = 0; i < 3; ++i) {
    const CaptureRecord& c = captures.at(i);
    EXPECT_EQ(c.refusal, Refusal::none) << i;
    EXPECT_EQ(c.edge_at, edges[i]) << i;
    EXPECT_EQ(c.mid_exposure, first_middle_from(*rig, edges[i])) << i;
  }
}

TEST(Procedure, KnowsTheScopesTrueWhereaboutsWithoutNoise) {
  const auto rig = finished(presses());
  ASSERT_TRUE(rig);
  for (std::size_t i = 0; i < rig->cart->captures().size(); ++i) {
    const CaptureRecord& c = rig->cart->captures().at(i);
    if (c.refusal != Refusal::none) continue;
    const Pose<M, C> truth = rig->devices->world().X_MC(c.mid_exposure);
    EXPECT_LT((c.X_MC.translation_mm - truth.translation_mm).norm(), 0.05) << i;
    // A constant phase between poll and device frame, under a period, is not seen without calibration
    // ([sync]).
    EXPECT_LT((c.X_MC.rotation - truth.rotation).norm(), 2e-3) << i;
  }
}

TEST(Procedure, TakesBackADoublePressToTheByte) {
  auto rig = CartRig::create(presses());
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(1100ms);
  const auto unpainted = rig->painting();
  rig->run_until(2700ms);
  EXPECT_NE(rig->painting(), unpainted);
  rig->run_until(3300ms);
  EXPECT_EQ(rig->painting(), unpainted);
  const auto& captures = rig->cart->captures();
  ASSERT_EQ(captures.size(), 2u);
  EXPECT_TRUE(captures.at(0).undone);
  EXPECT_TRUE(captures.at(1).undone);
}

TEST(Procedure, RefusesAPressWhileTheToolIsHiddenAndPaintsNothing) {
  auto rig = CartRig::create(presses());
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(4900ms);
  const auto before = rig->painting();
  rig->run_to_end();
  const auto& captures = rig->cart->captures();
  ASSERT_EQ(captures.size(), 4u);
  EXPECT_FALSE(captures.at(2).undone);
  EXPECT_EQ(captures.at(3).refusal, Refusal::tool_unseen);
  EXPECT_EQ(captures.at(3).edge_at, rig->at(4950ms));
  EXPECT_EQ(rig->painting(), before);
}

TEST(Procedure, StreamsEveryFrameOfAHeldPedalAndTakesTheStreamBackAsOne) {
  auto rig = CartRig::create(stream());
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(2700ms);
  const auto first_alone = rig->painting();
  rig->run_until(4300ms);
  EXPECT_NE(rig->painting(), first_alone);
  const auto& captures = rig->cart->captures();
  // Held from 2.8 to 4.1 s, a stream from 3.3 s on; exposures at 100 ms k + 7.1 ms: the press has k = 28, the
  // stream k = 33 .. 40.
  ASSERT_EQ(captures.size(), 1u + 1u + 8u);
  for (std::size_t i = 1; i < captures.size(); ++i) EXPECT_EQ(captures.at(i).unit, captures.at(1).unit) << i;

  rig->run_to_end();
  EXPECT_EQ(rig->painting(), first_alone);
  EXPECT_FALSE(captures.at(0).undone);
  for (std::size_t i = 1; i < captures.size(); ++i) EXPECT_TRUE(captures.at(i).undone) << i;
}

TEST(Procedure, TellsTheCoverageWithinTwoPicturesOfWhatChangedIt) {
  auto rig = CartRig::create(presses());
  ASSERT_TRUE(rig && rig->arm());
  const Nanos period = period_of(rig->config.panel.refresh_hz);
  const auto& captures = rig->cart->captures();
  Nanos until = 0ms;
  while (captures.size() == 0 && until < 2s) rig->run_until(until += period);
  ASSERT_EQ(captures.size(), 1u);
  rig->run_until(until += 2 * period);
  EXPECT_GT(rig->cart->now().coverage, 0);

  while (!captures.at(0).undone && until < 4s) rig->run_until(until += period);
  ASSERT_TRUE(captures.at(0).undone);
  rig->run_until(until += 2 * period);
  EXPECT_EQ(rig->cart->now().coverage, 0);
}

TEST(Procedure, TellsTheCoverageWhileItGrows) {
  auto rig = CartRig::create(presses());
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(1100ms);
  EXPECT_EQ(rig->cart->now().coverage, 0);
  rig->run_until(2700ms);
  EXPECT_GT(rig->cart->now().coverage, 0);
  EXPECT_LT(rig->cart->now().coverage, 1);
}

TEST(Procedure, ShowsEveryFrameInTimeAndBringsEveryBufferHome) {
  const auto rig = finished(presses());
  ASSERT_TRUE(rig);
  const CartFigures figures = rig->cart->figures();
  EXPECT_EQ(figures.queue_drops, 0u);
  EXPECT_EQ(figures.sequence_gaps, 0u);
  EXPECT_EQ(figures.frames_taken, 54u);  // 5.4 s at 10 Hz
  ASSERT_EQ(rig->cart->frames().size(), 54u);
  for (std::size_t i = 0; i < 54; ++i) EXPECT_FALSE(rig->cart->frames().at(i).late) << i;
  EXPECT_EQ(rig->camera->out(), 1u) << "the picture in the inset, and no other";
  EXPECT_EQ(rig->camera->lent_twice(), 0);
  EXPECT_EQ(rig->camera->returned_twice(), 0);
}

}  // namespace
}  // namespace orcart::testing
