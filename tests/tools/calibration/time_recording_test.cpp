// Folders of pictures with two tables, as other programs record them: read, fitted, and refused in words.
#include "tools/calibration/time_recording.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "firmware-host/files/scope_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/calibration/drawn_board.hpp"
#include "tests/tools/calibration/simulated_board.hpp"
#include "tests/tools/calibration/simulated_moves.hpp"
#include "tools/calibration/time_command.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

using testing::Hand;
using testing::SimulatedMoves;

std::string row_of(const Pose<T, S>& X) {
  std::string row;
  for (int i = 0; i < 3; ++i)
    row += json::format(",%.9g,%.9g,%.9g,%.6f", X.rotation(i, 0), X.rotation(i, 1), X.rotation(i, 2),
                        X.translation_mm[i]);
  return row + "\n";
}

/// A board 45 mm before the scope's resting place, in pictures of 320x240, and the tracker's poses.
ScopeModel write_recording(const TemporaryFolder& folder, const SimulatedMoves& task) {
  const Hand hand(task);
  ScopeModel scope = testing::drawn_scope(testing::test_lens(LensModel::brown), 320);
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.5);
  scope.mask.radius_px = 115;
  scope.X_SC = testing::moves_X_SC();
  EXPECT_TRUE(write_scope(folder / "scope.toml", scope));
  const testing::DrawnBoard board(scope, {});
  const Pose<T, B> X_TB = hand.at(0) * scope.X_SC * testing::board_before(45, {0.2, -0.1, 0.3});
  std::string frames = "image,time_ms\n", poses = "time_ms,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n";
  unsigned number = 0;
  for (const double t : testing::seen_instants(hand, task)) {
    const std::string name = json::format("frame%04u.png", number);
    cv::imwrite((folder / name).string(),
                board.seen_from((hand.at(t) * scope.X_SC).inverse() * X_TB, number++));
    frames += name + json::format(",%.4f\n", 1e3 * (t - task.lag_s));
  }
  const PoseTrack track = testing::simulated_track(hand, task);
  for (const TrackedPose& pose : track.samples())
    poses += json::format("%.4f", 1e3 * pose.at_s) + row_of(pose.X_TS);
  folder.write("frames.csv", frames);
  folder.write("poses.csv", poses);
  return scope;
}

std::string refusal(const TemporaryFolder& folder, const std::string& scope = "scope.toml") {
  const auto read = read_time_recording(folder / "", scope.empty() ? "" : folder / scope);
  return read ? "accepted" : read.error().message;
}

TEST(TimeRecording, OfABoardInAFolderTellsTheLag) {
  const TemporaryFolder folder;
  const SimulatedMoves task{.movements = 5, .lag_s = -0.034, .video_hz = 25, .reach_mm = 8, .turn_rad = 0.15};
  write_recording(folder, task);
  const auto found = calibrate_time({.recording = folder / "",
                                     .scope = folder / "scope.toml",
                                     .pattern = parse_pattern("chessboard:9x8:3mm").value()},
                                    {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->tracker_against_video_s, task.lag_s, found->fit.half_width_s);
  EXPECT_LE(found->fit.half_width_s, 0.003);
  EXPECT_NE(time_page(*found).find("<svg"), std::string::npos);
  EXPECT_NE(time_json(*found).find("\"motion_from\": \"board\""), std::string::npos);
  RecordProperty("lag_us", static_cast<int>(1e6 * found->tracker_against_video_s));
  RecordProperty("half_width_us", static_cast<int>(1e6 * found->fit.half_width_s));
}

TEST(TimeRecording, IsRefusedInWordsWhereItCannotBeRead) {
  const TemporaryFolder folder;
  write_recording(folder, {.movements = 1, .video_hz = 3});
  EXPECT_EQ(refusal(folder), "accepted");
  EXPECT_NE(refusal(folder, "").find("--scope scope.toml is wanted"), std::string::npos);
  folder.write("frames.csv", "image,time_ms\nframe0000.png,10\nframe0001.png,10\n");
  EXPECT_NE(refusal(folder).find("frames.csv:3: the time does not rise"), std::string::npos);
  folder.write("frames.csv", "frame0000.png;10\n");
  EXPECT_NE(refusal(folder).find("frames.csv:1: \"frame0000.png;10\" names no picture"), std::string::npos);
  folder.write("frames.csv", "absent.png,10\n");
  EXPECT_NE(refusal(folder).find("absent.png: cannot be read as a picture"), std::string::npos);
  folder.write("frames.csv", "frame0000.png,10\n");
  folder.write("poses.csv", "one,1,0,0,900,0,1,0,0,0,0,1,0\n");
  EXPECT_NE(refusal(folder).find("has no time"), std::string::npos);
  cv::imwrite((folder / "frame0000.png").string(), cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(9)));
  folder.write("poses.csv", "20,1,0,0,900,0,1,0,0,0,0,1,0\n");
  EXPECT_NE(refusal(folder).find("64x64 px; the scope's 320x240"), std::string::npos);
}

TEST(TimeRecording, ALaterPictureOfAnotherSizeIsRefused) {
  const TemporaryFolder folder;
  write_recording(folder, {.movements = 1, .video_hz = 10});
  cv::imwrite((folder / "frame0003.png").string(), cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(9)));
  const auto found = calibrate_time({.recording = folder / "", .scope = folder / "scope.toml"}, {});
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("frame0003.png: 64x64 px; the scope's 320x240"), std::string::npos)
      << found.error().message;
}

TEST(TimeRecording, OfDarkPicturesIsRefused) {
  const TemporaryFolder folder;
  write_recording(folder, {.movements = 1, .video_hz = 10});
  for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
    if (entry.path().extension() == ".png")
      cv::imwrite(entry.path().string(), cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(3)));
  TimeCommand command{.recording = folder / "", .scope = folder / "scope.toml"};
  const auto features = calibrate_time(command, {});
  ASSERT_FALSE(features);
  EXPECT_NE(features.error().message.find("features could be followed in 0 of"), std::string::npos);
  command.pattern = parse_pattern("chessboard:9x8:3mm").value();
  const auto board = calibrate_time(command, {});
  ASSERT_FALSE(board);
  EXPECT_NE(board.error().message.find("was found in 0 of"), std::string::npos);
}

}  // namespace
}  // namespace orcart
