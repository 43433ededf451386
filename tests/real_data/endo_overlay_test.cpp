// One real laparoscope frame with published pinhole and pose, painted onto its plane: the chessboard's
// corners are found again in the painting, at their known millimetres.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "tests/real_data/data_folder.hpp"
#include "tools/evaluate/recorded/flat_painting.hpp"

namespace orcart {
namespace {

constexpr const char* kSet = "endo_lap_chess_overlay";
constexpr int kBoardWidthMm = 39, kBoardHeightMm = 27, kSquareMm = 3;
constexpr double kPixelMm = 0.05;  ///< of atlas and flat painting
/// The board with a margin of 2 mm.
const PlaneExtent kPlane{.low_mm = {-2, -2}, .high_mm = {41, 29}};

template <std::size_t Count>
std::array<double, Count> numbers_of(const std::filesystem::path& file) {
  std::array<double, Count> numbers{};
  std::ifstream in(file);
  for (double& number : numbers) in >> number;
  EXPECT_TRUE(in) << file;
  return numbers;
}

/// The published pinhole, over the whole picture: the frame is undistorted already.
ScopeModel published_scope(const std::filesystem::path& folder) {
  const auto k = numbers_of<9>(folder / "calib.left.intrinsic.txt");
  ScopeModel scope{.name = "left-1095", .width_px = 1920, .height_px = 1080};
  scope.lens = {.fx_px = k[0], .fy_px = k[4], .cx_px = k[2], .cy_px = k[5], .max_angle_rad = 1.2};
  scope.mask = {.cx_px = 960, .cy_px = 540, .radius_px = 1200, .soft_edge_px = 0};
  scope.cone_half_angle_rad = 0.6;
  scope.far_mm = 250;
  return scope;
}

/// The file takes target to camera.
Pose<M, C> published_pose(const std::filesystem::path& folder) {
  const auto x = numbers_of<16>(folder / "left-1095.extrinsic.txt");
  Eigen::Matrix3d R_CM;
  R_CM << x[0], x[1], x[2], x[4], x[5], x[6], x[8], x[9], x[10];
  return Pose<C, M>{.rotation = nearest_rotation(R_CM).rotation, .translation_mm = {x[3], x[7], x[11]}}
      .inverse();
}

/// Looks at the picture where a person asks for it.
void keep_for_eyes(const cv::Mat& picture) {
  const char* folder = std::getenv("ORCART_PICTURES");
  if (folder == nullptr) return;
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < picture.rows * picture.cols; ++i)
    rgba.insert(rgba.end(), {picture.data[i], picture.data[i], picture.data[i], 255});
  ASSERT_TRUE(
      write_png(std::filesystem::path(folder) / "endo_overlay.png", picture.cols, picture.rows, rgba));
}

using Corners = std::vector<Eigen::Vector2d>;  ///< on the plane, mm, row by row

Corners known_corners() {
  Corners corners;
  for (int y = 0; y <= kBoardHeightMm; y += kSquareMm)
    for (int x = 0; x <= kBoardWidthMm; x += kSquareMm) corners.emplace_back(x, y);
  return corners;
}

/// Found in the painting, each from where it is known to be.
Corners painted_corners(const FlatPainting& flat, const cv::Mat& picture) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& corner : known_corners()) points.push_back(flat.pixel_of(corner));
  const int half_window = static_cast<int>(0.7 / kPixelMm);
  cv::cornerSubPix(picture, points, {half_window, half_window}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 100, 1e-4});
  Corners corners;
  for (const cv::Point2f& point : points) corners.push_back(flat.place_mm(point));
  return corners;
}

/// The corners that were published as found in the frame, on the plane: what the pose itself makes of them.
Corners published_corners(const std::filesystem::path& folder, const ScopeModel& scope,
                          const Pose<M, C>& X_MC) {
  std::ifstream in(folder / "left-1095-undistorted.png.points.txt");
  Corners corners;
  for (double u = 0, v = 0; in >> u >> v;) {
    const Eigen::Vector3d ray = X_MC.rotation * direction_of(scope.lens, {u, v}).value();
    corners.emplace_back((X_MC.translation_mm - ray * (X_MC.translation_mm.z() / ray.z())).head<2>());
  }
  return corners;
}

struct Figures {
  double mean_mm = 0, rms_mm = 0, max_mm = 0;
};

Figures differences(const Corners& a, const Corners& b) {
  Figures figures;
  const auto count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = (a[i] - b.at(i)).norm();
    figures.mean_mm += error / count;
    figures.rms_mm += error * error / count;
    figures.max_mm = std::max(figures.max_mm, error);
  }
  figures.rms_mm = std::sqrt(figures.rms_mm);
  return figures;
}

void record(const std::string& name, const Figures& figures) {
  ::testing::Test::RecordProperty(name + "_mean_mm", std::to_string(figures.mean_mm));
  ::testing::Test::RecordProperty(name + "_rms_mm", std::to_string(figures.rms_mm));
  ::testing::Test::RecordProperty(name + "_max_mm", std::to_string(figures.max_mm));
}

TEST(EndoOverlay, CornersLieAtTheirMillimetresInThePainting) {
  const auto folder = testing::data_folder(kSet);
  if (!folder) GTEST_SKIP() << testing::kNoData;
  auto frame = read_picture(*folder / "left-1095-undistorted.png");
  ASSERT_TRUE(frame) << frame.error().message;
  const ScopeModel scope = published_scope(*folder);
  const Pose<M, C> X_MC = published_pose(*folder);
  std::vector<PosedPicture> pictures;
  pictures.push_back({.picture = *std::move(frame), .X_MC = X_MC});
  const auto flat = paint_plane(kPlane, scope, pictures, {.texel_mm = kPixelMm});
  ASSERT_TRUE(flat) << flat.error().message;
  // But for the border, which blends into nothing as every silhouette does.
  const cv::Mat within = flat->painted(cv::Rect(10, 10, flat->painted.cols - 20, flat->painted.rows - 20));
  EXPECT_EQ(cv::countNonZero(within), within.rows * within.cols);

  cv::Mat picture;
  cv::cvtColor(flat->bgr, picture, cv::COLOR_BGR2GRAY);
  keep_for_eyes(picture);
  const Corners found = painted_corners(*flat, picture);
  const Figures error = differences(found, known_corners());
  const Corners published = published_corners(*folder, scope, X_MC);
  const Figures arithmetic = differences(found, published);
  record("painting", error);
  record("pose_alone", differences(published, known_corners()));
  record("painting_against_pose_alone", arithmetic);
  EXPECT_LE(error.mean_mm, 0.05);
  EXPECT_LE(error.max_mm, 0.12);
  EXPECT_LE(arithmetic.mean_mm, 0.01) << "the painting itself may add this to the published pose's error";
  EXPECT_LE(arithmetic.max_mm, 0.03);
}

}  // namespace
}  // namespace orcart
