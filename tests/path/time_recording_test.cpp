// A recording that the cart itself made tells the tracker's lag against the video, without a board.
#include <gtest/gtest.h>

#include "firmware-host/app/kept_session.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/path/cart_rig.hpp"
#include "tools/calibration/time_command.hpp"

namespace orcart::testing {
namespace {

/// Eight places, one every two seconds, and the pedal held for 4.4 s of every 5.
RigWish moves() {
  RigWish wish{.duration_s = 20,
               .camera_hz = 25,
               .texel_mm = 0.8,
               .script = {.press_every_s = 1.6, .undo_at = -1, .stream_at = -1, .hide_at = -1}};
  for (int i = 0; i < 4; ++i)
    wish.holds.push_back({.from = 100ms + i * 4900ms, .until = 100ms + i * 4900ms + 4700ms});
  return wish;
}

/// How long after mid-exposure the scope really was where the cart's captures have it.
double shift_of_poses_s(const CartRig& rig) {
  double best_s = 0, least = 1e300;
  for (int tenth_ms = -600; tenth_ms < 200; ++tenth_ms) {
    const double shift_s = 1e-4 * tenth_ms;
    double sum = 0;
    for (std::size_t i = 0; i < rig.cart->captures().size(); ++i) {
      const CaptureRecord& c = rig.cart->captures().at(i);
      if (c.refusal != Refusal::none) continue;
      const Pose<M, C> there = rig.devices->world().X_MC(c.mid_exposure + from_seconds(shift_s));
      sum += (there.translation_mm - c.X_MC.translation_mm).squaredNorm();
    }
    if (sum < least) least = sum, best_s = shift_s;
  }
  return best_s;
}

TEST(TimeRecording, OfTheCartTellsTheLagThatItWasMadeWith) {
  const TemporaryFolder folder;
  auto rig = CartRig::create(moves());
  ASSERT_TRUE(rig);
  rig->config.tracker_against_video = -40ms;  // what the cart itself adds is below
  auto session = KeptSession::create({.file = folder / "moves.orcart",
                                      .config = rig->config,
                                      .patient = rig->patient,
                                      .started_at = rig->clock.now()});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE(rig->arm(&(*session)->stage()));
  rig->run_to_end();
  rig->cart->stop();
  ASSERT_TRUE((*session)->finish(rig->cart->stage_ledgers()));

  const double shift_s = shift_of_poses_s(*rig);
  EXPECT_NEAR(shift_s, -0.040, 0.0015) << "polls in step with the device's frames left 5.9 ms";
  const double truth_s = -0.040 - shift_s;
  const auto found = calibrate_time({.recording = folder / "moves.orcart"}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->recorded_with_s, -0.040, 1e-9);
  EXPECT_NEAR(found->tracker_against_video_s, truth_s, found->fit.half_width_s);
  EXPECT_LE(found->fit.half_width_s, 0.003);
  EXPECT_NE(sync_snippet(*found).find("tracker_against_video_ms = "), std::string::npos);
  RecordProperty("truth_us", static_cast<int>(1e6 * truth_s));
  RecordProperty("lag_us", static_cast<int>(1e6 * found->tracker_against_video_s));
  RecordProperty("half_width_us", static_cast<int>(1e6 * found->fit.half_width_s));
}

}  // namespace
}  // namespace orcart::testing
