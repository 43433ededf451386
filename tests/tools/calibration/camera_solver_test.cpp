// Lenses found again from simulated corners, OpenCV's answer on the same corners, and sets that leave the
// lens open.
#include "tools/calibration/camera_solver.hpp"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "tests/tools/calibration/simulated_board.hpp"
#include "tools/calibration/camera_checks.hpp"
#include "tools/calibration/tip.hpp"

namespace orcart {
namespace {

using testing::simulated_views;
using testing::test_lens;

CameraTask task_for(LensModel model) {
  return {.model = model,
          .coefficients = model == LensModel::poly4     ? 3
                          : model == LensModel::fisheye ? 4
                                                        : 5,
          .centre_px = {319.5, 239.5}};
}

TEST(CameraSolver, FindsEachModelAgainWithoutNoise) {
  for (const LensModel model : {LensModel::brown, LensModel::fisheye, LensModel::poly4}) {
    const Lens lens = test_lens(model);
    auto views = simulated_views(lens, {});
    const auto fit = solve_camera(views, task_for(model));
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(fit->rms_px, 1e-4) << static_cast<int>(model);
    EXPECT_NEAR(fit->lens.fx_px, lens.fx_px, 0.01);
    EXPECT_NEAR(fit->lens.fy_px, lens.fy_px, 0.01);
    EXPECT_NEAR(fit->lens.cx_px, lens.cx_px, 0.05);
    EXPECT_TRUE(fit->determined);
  }
}

TEST(CameraSolver, AgreesWithOpenCvOnTheSameCorners) {
  auto views = simulated_views(test_lens(LensModel::brown), {.noise_px = 0.3});
  const auto fit = solve_camera(views, task_for(LensModel::brown));
  ASSERT_TRUE(fit);
  std::vector<std::vector<cv::Point3f>> places;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BoardView& view : views) {
    places.emplace_back();
    pixels.emplace_back();
    for (const BoardCorner& c : view.corners) {
      places.back().emplace_back(static_cast<float>(c.board_mm.x()), static_cast<float>(c.board_mm.y()),
                                 0.0F);
      pixels.back().emplace_back(static_cast<float>(c.pixel_px.x()), static_cast<float>(c.pixel_px.y()));
    }
  }
  cv::Mat k, d;
  std::vector<cv::Mat> r, t;
  const double rms = cv::calibrateCamera(places, pixels, {640, 480}, k, d, r, t);
  EXPECT_NEAR(fit->rms_px, rms, 0.001 * rms);
  EXPECT_NEAR(fit->lens.fx_px, k.at<double>(0, 0), 0.001 * fit->lens.fx_px);
  EXPECT_NEAR(fit->lens.cy_px, k.at<double>(1, 2), 0.3);
  for (std::size_t v = 0; v < views.size(); ++v)
    EXPECT_NEAR(fit->views[v].X_CB.translation_mm.z(), t[v].at<double>(2), 0.01);
}

TEST(CameraSolver, ItsDeviationsCoverTheTruth) {
  const Lens lens = test_lens(LensModel::brown);
  auto views = simulated_views(lens, {.noise_px = 0.3});
  const auto fit = solve_camera(views, task_for(LensModel::brown));
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->deviations[0], 0.05);
  EXPECT_LT(std::abs(fit->lens.fx_px - lens.fx_px), 4 * fit->deviations[0]);
  EXPECT_LT(std::abs(fit->lens.cx_px - lens.cx_px), 4 * fit->deviations[2]);
}

TEST(CameraSolver, DropsACornerThatIsFarOff) {
  auto views = simulated_views(test_lens(LensModel::brown), {.noise_px = 0.1});
  views[2].corners[40].pixel_px += Eigen::Vector2d(15, -9);
  const auto fit = solve_camera(views, task_for(LensModel::brown));
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->views[2].dropped, 1U);
  EXPECT_LT(fit->rms_px, 0.2);
}

TEST(CameraChecks, RefuseWhatLeavesTheFocalLengthOpen) {
  const Lens lens = test_lens(LensModel::brown);
  auto flat = simulated_views(lens, {.noise_px = 0.1, .tilt_rad = 0.01});
  const auto fit = solve_camera(flat, task_for(LensModel::brown));
  ASSERT_TRUE(fit);
  const auto refused = check_fit(*fit, task_for(LensModel::brown));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("no view is tilted"), std::string::npos);
}

TEST(CameraSolver, KnownDistancesStandInForTilt) {
  const Lens lens = test_lens(LensModel::brown);
  std::vector<Pose<C, B>> poses;
  auto flat = simulated_views(lens, {.noise_px = 0.1, .tilt_rad = 0.05}, &poses);
  CameraTask task = task_for(LensModel::brown);
  for (std::size_t v = 0; v < flat.size(); ++v)
    task.distances_mm.push_back(axis_distance_mm(poses[v]).value() - 25);
  for (std::size_t v = 0; v < flat.size(); v += 2)  // counted from the opposite corner, as may happen
    for (BoardCorner& c : flat[v].corners) c.board_mm = Eigen::Vector3d(26, 18, 0) - c.board_mm;
  const auto fit = solve_camera(flat, task);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(check_fit(*fit, task));
  EXPECT_NEAR(fit->lens.fx_px, lens.fx_px, 0.005 * lens.fx_px);
}

TEST(CameraChecks, NameBadSets) {
  const Lens lens = test_lens(LensModel::brown);
  const Pattern pattern = parse_pattern("chessboard:14x10:2mm").value();
  const auto views = simulated_views(lens, {});
  EXPECT_TRUE(check_views(views, pattern));
  EXPECT_NE(check_views({views[0], views[1]}, pattern).error().message.find("too few views"),
            std::string::npos);
  auto doubled = views;
  doubled.push_back(views[3]);
  doubled.back().image = "copy";
  EXPECT_NE(check_views(doubled, pattern).error().message.find("copy: the same view as view3"),
            std::string::npos);
  auto mixed = views;
  mixed[4].width_px = 800;
  EXPECT_NE(check_views(mixed, pattern).error().message.find("view4: 800x480"), std::string::npos);
  auto other = views;
  for (BoardView& view : other) view.anchor = Anchor::none, view.columns = 9, view.rows = 6;
  EXPECT_NE(check_views(other, pattern).error().message.find("9x6, not chessboard:14x10:2mm"),
            std::string::npos);
}

}  // namespace
}  // namespace orcart
