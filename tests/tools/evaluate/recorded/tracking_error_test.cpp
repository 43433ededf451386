// Tools at rest, tools in a hand, numbers that never change, and what views imply.
#include "tools/evaluate/recorded/tracking_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/evaluate/random_stream.hpp"

namespace orcart {
namespace {

constexpr double kNoise_mm = 0.1;  ///< an axis

ToolTrack noisy(std::size_t readings, double drift_mm) {
  RandomStream random(3, 1);
  ToolTrack track{.file = "drawn", .tool = "one", .places_mm = {}};
  for (std::size_t i = 0; i < readings; ++i)
    track.places_mm.emplace_back(kNoise_mm * random.gaussian3() +
                                 Eigen::Vector3d(drift_mm * static_cast<double>(i), 300, -1800));
  return track;
}

TEST(StillTools, ScatterAsTheirNoise) {
  const StillTools still = still_tools({noisy(2000, 0)});
  ASSERT_EQ(still.stretches.size(), 1U);
  EXPECT_EQ(still.stretches[0].readings, 2000U);
  EXPECT_EQ(still.error.count, 2000U);
  // Maxwell: mean 2 sqrt(2 / pi) sigma, s.d. sqrt(3 - 8 / pi) sigma.
  EXPECT_NEAR(still.error.mean, 2 * std::sqrt(2 / std::numbers::pi) * kNoise_mm, 0.003);
  EXPECT_NEAR(still.error.sd, std::sqrt(3 - 8 / std::numbers::pi) * kNoise_mm, 0.003);
  EXPECT_NEAR(still.stretches[0].rms_mm, std::sqrt(3.0) * kNoise_mm, 0.004);
  EXPECT_LT(still.error.mean_low, still.error.mean);
  EXPECT_LT(still.error.mean_high - still.error.mean_low, 0.01);
}

TEST(StillTools, InAHandAreLeftOut) {
  const StillTools still = still_tools({noisy(200, 0.03)});
  EXPECT_TRUE(still.stretches.empty());
  EXPECT_GT(still.moving, 0U);
}

TEST(StillTools, ThatRepeatOneNumberAreNoMeasurement) {
  ToolTrack frozen{.file = "drawn", .tool = "one", .places_mm = {}};
  frozen.places_mm.assign(100, {1, 2, 3});
  const StillTools still = still_tools({frozen});
  EXPECT_TRUE(still.stretches.empty());
  EXPECT_EQ(still.moving, 0U);
}

TEST(ToolTracks, OfASequenceAreItsToolsInTheTracker) {
  const TemporaryFolder folder;
  std::ofstream(folder / "one.mha")
      << "ObjectType = Image\nNDims = 3\n"
         "Seq_Frame0000_StylusToTrackerTransform = 1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n"
         "Seq_Frame0000_StylusToReferenceTransform = 1 0 0 9 0 1 0 9 0 0 1 9 0 0 0 1\n"
         "Seq_Frame0001_StylusToTrackerTransform = 1 0 0 7 0 1 0 5 0 0 1 6 0 0 0 1\n";
  const auto tracks = tool_tracks(folder / "one.mha");
  ASSERT_TRUE(tracks) << tracks.error().message;
  ASSERT_EQ(tracks->size(), 1U);
  EXPECT_EQ((*tracks)[0].tool, "Stylus");
  ASSERT_EQ((*tracks)[0].places_mm.size(), 2U);
  EXPECT_EQ((*tracks)[0].places_mm[1], Eigen::Vector3d(7, 5, 6));
}

TEST(ToolTracks, OfPosesAreOneTool) {
  const TemporaryFolder folder;
  std::ofstream(folder / "poses.csv") << "a,1,0,0,40,0,1,0,50,0,0,1,60\nb,1,0,0,41,0,1,0,50,0,0,1,60\n";
  const auto tracks = tool_tracks(folder / "poses.csv");
  ASSERT_TRUE(tracks) << tracks.error().message;
  ASSERT_EQ(tracks->size(), 1U);
  EXPECT_EQ((*tracks)[0].places_mm[0], Eigen::Vector3d(40, 50, 60));
}

TEST(ToolTracks, RefuseWhatIsNoRecording) {
  const TemporaryFolder folder;
  std::ofstream(folder / "words.txt") << "these are words\n";
  for (const char* name : {"words.txt", "nowhere.mha"}) {
    const auto tracks = tool_tracks(folder / name);
    ASSERT_FALSE(tracks) << name;
    EXPECT_NE(tracks.error().message.find(name), std::string::npos) << tracks.error().message;
  }
}

TEST(TrackingError, OfRecordingsWithoutARestIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "poses.csv") << "a,1,0,0,40,0,1,0,50,0,0,1,60\nb,1,0,0,41,0,1,0,50,0,0,1,60\n";
  const auto error = tracking_error({folder / "poses.csv"}, {});
  ASSERT_FALSE(error);
  EXPECT_NE(error.error().message.find("no tool that stands still"), std::string::npos);
}

TEST(TrackingError, IsImpliedByTheMisfitAndSaysSo) {
  HandEyeCalibration calibration;
  calibration.task.noise.marker_mm = 0.2;
  calibration.views.resize(7);
  EXPECT_EQ(tracking_error({}, calibration)->from, TrackingFrom::nothing);
  calibration.spread =
      HandEyeSpread{.hand_eye = TwistCovariance::Zero(), .lens = {}, .misfit = 4, .freedom = 30};
  const auto error = tracking_error({}, calibration);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->from, TrackingFrom::implied);
  EXPECT_DOUBLE_EQ(error->marker_mm, 0.4);
  // The middle of four markers: half a marker's noise, 0.2 mm RMS.
  EXPECT_NEAR(error->error.mean, 0.2 * std::sqrt(8 / (3 * std::numbers::pi)), 1e-12);
  EXPECT_NEAR(std::hypot(error->error.mean, error->error.sd), 0.2, 1e-12);
  EXPECT_EQ(error->error.count, 7U);
  EXPECT_TRUE(std::isnan(error->error.max));
  // Chi-square of 30 degrees: 16.791 and 46.979 at 2.5 and 97.5 %.
  EXPECT_NEAR(error->error.mean_low, error->error.mean * std::sqrt(30 / 46.979), 2e-4);
  EXPECT_NEAR(error->error.mean_high, error->error.mean * std::sqrt(30 / 16.791), 2e-4);
}

}  // namespace
}  // namespace orcart
