// Real calibration sets: every reference value that is published or was verified with them.
#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/real_data/data_folder.hpp"
#include "tools/calibration/camera_command.hpp"
#include "tools/calibration/hand_eye_command.hpp"

namespace orcart {
namespace {

using testing::data_folder;

std::vector<std::filesystem::path> pictures(const std::filesystem::path& folder, const std::string& ending) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Result<CameraCalibration> calibrated(const std::filesystem::path& folder, const std::string& ending,
                                     const std::string& pattern, LensModel model = LensModel::brown) {
  return calibrate_camera(
      {.images = pictures(folder, ending), .pattern = parse_pattern(pattern).value(), .model = model}, {});
}

TEST(RealCamera, OpenCvsThirteenChessboards) {
  const auto folder = data_folder("cal_opencv_left");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto c = calibrated(*folder, ".jpg", "chessboard:9x6:25mm");
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->views.size(), 13U);
  EXPECT_LE(c->fit.rms_px, 0.1954);
  EXPECT_NEAR(c->scope.lens.fx_px, 532.827, 0.01 * 532.827);
  EXPECT_NEAR(c->scope.lens.fy_px, 532.946, 0.01 * 532.946);
  EXPECT_NEAR(c->scope.lens.cx_px, 342.487, 3.4);
  EXPECT_NEAR(c->scope.lens.cy_px, 233.856, 2.4);
  EXPECT_FALSE(c->mask.circle);
}

TEST(RealCamera, ALaparoscopesNineChessboards) {
  const auto folder = data_folder("cal_lap_viking_chess");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto c = calibrated(*folder, ".png", "chessboard:14x10:3mm");
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->views.size(), 9U);
  EXPECT_GE(c->fit.corners, 1255U);
  EXPECT_LT(c->fit.rms_px, 0.61);  // 0.581 with another corner finder; 0.7 is what its authors assert
  EXPECT_NEAR(c->scope.lens.fx_px, 2012.186, 0.01 * 2012.186);
  EXPECT_NEAR(c->scope.lens.fy_px, 2017.966, 0.01 * 2017.966);
  EXPECT_NEAR(c->scope.lens.cx_px, 944.717, 9.5);
}

TEST(RealCamera, ACapsulesTenChessboards) {
  const auto folder = data_folder("cal_endoslam_mirocam");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto c = calibrated(*folder, ".jpg", "chessboard:7x6:2mm");
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->views.size(), 10U);
  EXPECT_LT(c->fit.rms_px, 0.7729);
}

struct Cisst {
  CameraCalibration camera;
  HandEyeCalibration hand_eye;
};

/// Each picture has a .coords file of its own, so a table is made of them.
Result<Cisst> cisst(const std::filesystem::path& folder) {
  auto camera = calibrated(folder, ".png", "chessboard:18x16:2mm");
  if (!camera) return tl::unexpected(camera.error());
  const auto poses = std::filesystem::temp_directory_path() / ("orcart-cisst-" + std::to_string(::getpid()));
  std::filesystem::create_directories(poses);
  for (const auto& file : pictures(folder, ".coords"))
    std::filesystem::copy(file, poses / file.filename(), std::filesystem::copy_options::overwrite_existing);
  auto hand_eye = calibrate_hand_eye({.images = pictures(folder, ".png"),
                                      .poses = poses,
                                      .pattern = parse_pattern("chessboard:18x16:2mm").value()},
                                     camera->scope, {});
  std::filesystem::remove_all(poses);
  if (!hand_eye) return tl::unexpected(hand_eye.error());
  return Cisst{.camera = std::move(*camera), .hand_eye = std::move(*hand_eye)};
}

TEST(RealCamera, AllSevenPartialViewsOfTheColouredBoard) {
  const auto folder = data_folder("cal_cisst_chess");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto c = cisst(*folder);
  ASSERT_TRUE(c) << c.error().message;
  EXPECT_EQ(c->camera.views.size(), 7U);
  for (const BoardView& view : c->camera.views) EXPECT_EQ(view.anchor, Anchor::sure) << view.image;
  EXPECT_NEAR(c->camera.scope.lens.fx_px, 417.109, 0.03 * 417.109);
  EXPECT_NEAR(c->camera.scope.lens.fy_px, 379.373, 0.03 * 379.373);
  EXPECT_TRUE(c->camera.mask.circle);
  EXPECT_TRUE(c->camera.mask.notch_rad.has_value());
  EXPECT_EQ(c->hand_eye.names.size(), 7U);
  EXPECT_TRUE(std::any_of(c->hand_eye.notes.begin(), c->hand_eye.notes.end(), [](const std::string& note) {
    return note.find("X_CE is not known yet") != std::string::npos;
  }));
  EXPECT_LE(c->hand_eye.closed_form.scatter_mm,
            1.43);  // 1.26 over all seven views; 1.43 is the verified figure over five
  EXPECT_LE(c->hand_eye.refined.scatter_mm, 1.5);
  // 1.41; the 1.3 that is wanted is not in these poses: see tools/README.md.
  EXPECT_LE(c->hand_eye.leave_one_out_mm.value(), 1.45);
  EXPECT_NEAR(c->hand_eye.least_left_out_mm, 1.38, 0.02) << "no one hand-eye pose comes to 1.3";
}

TEST(RealHandEye, FourPosesOfARobotGiveTheVerifiedParkSolution) {
  const auto folder = data_folder("he_endoslam_robot");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto hands = read_poses(*folder / "extracted_hand2world_4x4_mm.txt");
  ASSERT_TRUE(hands) << hands.error().message;
  const double rows[4][6] = {
      {0.276462673, 0.030741789, -1.622124191, -25.347895739, 41.449368253, 225.731862031},
      {-0.358966732, 0.299334290, -1.280345748, -44.007124218, 22.724742911, 254.162562902},
      {-0.002118912, 0.132743691, -0.914597677, -40.388358157, 14.244690766, 232.123464812},
      {-0.312744867, -0.413202292, -0.944455637, -6.400429874, 15.514325459, 225.117967483}};
  std::vector<HandEyeView> views;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d turn(rows[i][0], rows[i][1], rows[i][2]);
    views.push_back(
        {.X_TS = hands->poses[i].X_TS,
         .X_CB = {.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
                  .translation_mm = {rows[i][3], rows[i][4], rows[i][5]}}});
  }
  const auto fit = hand_eye_closed_form(views);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->X_SC.translation_mm - Eigen::Vector3d(-0.8032, 9.9953, 68.4670)).norm(), 0.15);
  EXPECT_NEAR(fit->scatter_mm, 2.357, 0.02);
}

}  // namespace
}  // namespace orcart
