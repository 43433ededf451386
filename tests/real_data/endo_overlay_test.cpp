// One real laparoscope frame with published pinhole and pose, painted onto its plane: the chessboard's
// corners are found again in the painting, at their known millimetres.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "tests/real_data/data_folder.hpp"

namespace orcart {
namespace {

constexpr const char* kSet = "endo_lap_chess_overlay";
constexpr double kMarginMm = 2, kBoardWidthMm = 39, kBoardHeightMm = 27, kSquareMm = 3;
constexpr double kPixelMm = 0.05;  ///< of the painting resampled onto a grid of the plane

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

/// The board's plane z = 0 with a margin, in squares of 1 mm; its normal looks at the camera, towards -z.
Surface board_plane() {
  const int columns = static_cast<int>(kBoardWidthMm + 2 * kMarginMm);
  const int rows = static_cast<int>(kBoardHeightMm + 2 * kMarginMm);
  TriangleMesh mesh;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x)
      mesh.vertices_mm.emplace_back(static_cast<float>(x - kMarginMm), static_cast<float>(y - kMarginMm), 0);
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y)});
      mesh.triangles.push_back({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
    }
  return *make_surface(std::move(mesh), "the board's plane");
}

/// The atlas between texel centres, grey 0..255; negative where a neighbour has no paint.
double grey_at(const AtlasPicture& atlas, const Eigen::Vector2f& texels) {
  const Eigen::Vector2f centred = texels - Eigen::Vector2f(0.5f, 0.5f);
  const int x0 = static_cast<int>(std::floor(centred.x())), y0 = static_cast<int>(std::floor(centred.y()));
  double sum = 0;
  for (const auto& [dx, dy] : {std::array{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
    const auto* rgba = &atlas.rgba[4 * static_cast<std::size_t>((y0 + dy) * atlas.width_texels + x0 + dx)];
    if (rgba[3] == 0) return -1;
    const double weight = (1 - std::abs(centred.x() - static_cast<float>(x0 + dx))) *
                          (1 - std::abs(centred.y() - static_cast<float>(y0 + dy)));
    sum += weight * (0.299 * rgba[0] + 0.587 * rgba[1] + 0.114 * rgba[2]);
  }
  return sum;
}

/// Where in the atlas a point of the plane lies, texels; `board_mm` counts from the plane's first corner.
Eigen::Vector2f texels_of(const Surface& surface, const AtlasLayout& layout,
                          const Eigen::Vector2d& board_mm) {
  constexpr int kColumns = static_cast<int>(kBoardWidthMm + 2 * kMarginMm);
  const Eigen::Vector2d within = board_mm - board_mm.array().floor().matrix();
  const int square = static_cast<int>(board_mm.y()) * kColumns + static_cast<int>(board_mm.x());
  const auto triangle = static_cast<std::size_t>(2 * square + (within.sum() > 1 ? 1 : 0));
  const auto corner = [&](std::size_t i) -> Eigen::Vector2d {
    return surface.mesh.vertices_mm[surface.mesh.triangles[triangle][i]].head<2>().cast<double>();
  };
  Eigen::Matrix2d edges;
  edges << corner(1) - corner(0), corner(2) - corner(0);
  const Eigen::Vector2d offset = board_mm.array() - kMarginMm;
  const Eigen::Vector2f b = (edges.inverse() * (offset - corner(0))).cast<float>();
  const auto& place = layout.corners_texels[triangle];
  return place[0] + b.x() * (place[1] - place[0]) + b.y() * (place[2] - place[0]);
}

/// The painting as a picture of the plane: pixel (0, 0) is centred on (-margin, -margin) mm. Only the plane's
/// own border may lack paint, as every silhouette does.
cv::Mat resampled(const Surface& surface, const AtlasLayout& layout, const AtlasPicture& atlas) {
  const int width = static_cast<int>(std::lround((kBoardWidthMm + 2 * kMarginMm) / kPixelMm));
  const int height = static_cast<int>(std::lround((kBoardHeightMm + 2 * kMarginMm) / kPixelMm));
  const cv::Rect without_border = {10, 10, width - 20, height - 20};
  cv::Mat picture(height, width, CV_8UC1);
  int unpainted = 0;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double grey = grey_at(atlas, texels_of(surface, layout, {u * kPixelMm, v * kPixelMm}));
      if (grey < 0 && without_border.contains({u, v})) ++unpainted;
      picture.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(std::lround(std::max(grey, 0.0)));
    }
  EXPECT_EQ(unpainted, 0);
  return picture;
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
  for (double y = 0; y <= kBoardHeightMm; y += kSquareMm)
    for (double x = 0; x <= kBoardWidthMm; x += kSquareMm) corners.emplace_back(x, y);
  return corners;
}

/// Found in the painting, each from where it is known to be.
Corners painted_corners(const cv::Mat& picture) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& corner : known_corners())
    points.emplace_back(static_cast<float>((corner.x() + kMarginMm) / kPixelMm),
                        static_cast<float>((corner.y() + kMarginMm) / kPixelMm));
  const int half_window = static_cast<int>(0.7 / kPixelMm);
  cv::cornerSubPix(picture, points, {half_window, half_window}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 100, 1e-4});
  Corners corners;
  for (const cv::Point2f& point : points)
    corners.emplace_back(point.x * kPixelMm - kMarginMm, point.y * kPixelMm - kMarginMm);
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
  const Surface plane = board_plane();
  const ScopeModel scope = published_scope(*folder);
  const Pose<M, C> X_MC = published_pose(*folder);
  auto painter = OfflinePainter::create(plane, scope, {.texel_mm = 0.05});
  ASSERT_TRUE(painter) << painter.error().message;
  const auto painted = painter->paint(frame->descriptor(), X_MC);
  ASSERT_TRUE(painted) << painted.error().message;
  EXPECT_EQ(painted->triangles, plane.mesh.triangles.size());

  const cv::Mat picture = resampled(plane, painter->layout(), painter->painter().read_back());
  keep_for_eyes(picture);
  const Corners found = painted_corners(picture);
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
