// The plane is a grid, so the triangle behind a place of it is told by arithmetic.
#include "tools/evaluate/recorded/flat_painting.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "firmware-host/files/surface_file.hpp"

namespace orcart {
namespace {

/// Where in the atlas a place of the plane lies, in texels; two triangles a square, cut from its lower right
/// to its upper left.
Eigen::Vector2f texels_at(const AtlasLayout& layout, const PlaneExtent& extent, const Eigen::Vector2d& mm) {
  const Eigen::Vector2d from_low = mm - extent.low_mm.cast<double>();
  const int column = std::clamp(static_cast<int>(from_low.x()), 0, extent.columns() - 1),
            row = std::clamp(static_cast<int>(from_low.y()), 0, extent.rows() - 1);
  const Eigen::Vector2f in = (from_low - Eigen::Vector2d(column, row)).cast<float>();
  const bool upper = in.x() + in.y() > 1;
  const auto& corners =
      layout
          .corners_texels[static_cast<std::size_t>(2 * (row * extent.columns() + column) + (upper ? 1 : 0))];
  // Weights of the second and third corner, in the order plane_surface() gives them.
  const float second = upper ? 1 - in.x() : in.y(), third = upper ? in.y() - second : in.x();
  return corners[0] + second * (corners[1] - corners[0]) + third * (corners[2] - corners[0]);
}

void flatten_row(int v, const AtlasLayout& layout, const AtlasPicture& atlas, const AtlasRecords& records,
                 FlatPainting& flat) {
  const auto width = static_cast<std::size_t>(atlas.width_texels);
  for (int u = 0; u < flat.bgr.cols; ++u) {
    const Eigen::Vector2f at =
        texels_at(layout, flat.extent, flat.place_mm({static_cast<float>(u), static_cast<float>(v)})) -
        Eigen::Vector2f(0.5F, 0.5F);
    const Eigen::Vector2f low = at.array().floor();
    const Eigen::Vector2f part = at - low;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    bool whole = true;
    for (int corner = 0; corner < 4; ++corner) {
      const int dx = corner % 2, dy = corner / 2;
      const auto texel = static_cast<std::size_t>(static_cast<int>(low.y()) + dy) * width +
                         static_cast<std::size_t>(static_cast<int>(low.x()) + dx);
      const std::uint8_t* rgba = &atlas.rgba[4 * texel];
      whole = whole && rgba[3] > 0;
      const float weight = (dx == 1 ? part.x() : 1 - part.x()) * (dy == 1 ? part.y() : 1 - part.y());
      sum += weight * Eigen::Vector3f(rgba[2], rgba[1], rgba[0]);
    }
    if (!whole) continue;
    flat.painted.at<std::uint8_t>(v, u) = 255;
    flat.bgr.at<cv::Vec3b>(v, u) = {cv::saturate_cast<std::uint8_t>(sum.x()),
                                    cv::saturate_cast<std::uint8_t>(sum.y()),
                                    cv::saturate_cast<std::uint8_t>(sum.z())};
    const auto nearest =
        static_cast<std::size_t>(std::lround(at.y())) * width + static_cast<std::size_t>(std::lround(at.x()));
    flat.capture.at<std::uint16_t>(v, u) = records.texels[nearest].capture;
  }
}

}  // namespace

Surface plane_surface(const PlaneExtent& extent) {
  TriangleMesh mesh;
  const int columns = extent.columns(), rows = extent.rows();
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x)
      mesh.vertices_mm.emplace_back(static_cast<float>(extent.low_mm.x() + x),
                                    static_cast<float>(extent.low_mm.y() + y), 0.0F);
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y)});
      mesh.triangles.push_back({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
    }
  return *make_surface(std::move(mesh), "the board's plane");
}

Result<FlatPainting> paint_plane(const PlaneExtent& extent, const ScopeModel& scope,
                                 std::vector<PosedPicture>& pictures, const OfflinePaintOptions& options) {
  const Surface surface = plane_surface(extent);
  auto painter = OfflinePainter::create(surface, scope, options);
  if (!painter) return tl::unexpected(painter.error());
  for (PosedPicture& posed : pictures)
    if (const auto painted = painter->paint(posed.picture.descriptor(), posed.X_MC); !painted)
      return tl::unexpected(painted.error());
  FlatPainting flat{.extent = extent, .pixel_mm = options.texel_mm};
  const int width = static_cast<int>(std::lround(extent.columns() / flat.pixel_mm)),
            height = static_cast<int>(std::lround(extent.rows() / flat.pixel_mm));
  flat.bgr = cv::Mat::zeros(height, width, CV_8UC3);
  flat.painted = cv::Mat::zeros(height, width, CV_8U);
  flat.capture = cv::Mat::zeros(height, width, CV_16U);
  const AtlasPicture atlas = painter->painter().read_back();
  const AtlasRecords records = painter->painter().read_records();
  for (int v = 0; v < height; ++v) flatten_row(v, painter->layout(), atlas, records, flat);
  return flat;
}

cv::Mat carried_on(const FlatPainting& painting, double margin_mm) {
  if (painting.painted.empty()) return painting.bgr;
  cv::Mat away_px, nearest;  // of each pixel: how far, and the number of, the nearest painted one
  cv::distanceTransform(255 - painting.painted, away_px, nearest, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<cv::Vec3b> colours(static_cast<std::size_t>(cv::countNonZero(painting.painted)) + 1);
  for (int v = 0; v < painting.bgr.rows; ++v)
    for (int u = 0; u < painting.bgr.cols; ++u)
      if (painting.painted.at<std::uint8_t>(v, u) != 0)
        colours[static_cast<std::size_t>(nearest.at<std::int32_t>(v, u))] = painting.bgr.at<cv::Vec3b>(v, u);
  cv::Mat wider = painting.bgr.clone();
  for (int v = 0; v < wider.rows; ++v)
    for (int u = 0; u < wider.cols; ++u)
      if (away_px.at<float>(v, u) * painting.pixel_mm <= margin_mm)
        wider.at<cv::Vec3b>(v, u) = colours[static_cast<std::size_t>(nearest.at<std::int32_t>(v, u))];
  return wider;
}

Picture picture_of(const cv::Mat& bgr) {
  Picture picture{.width_px = bgr.cols, .height_px = bgr.rows, .rgba = {}};
  picture.rgba.reserve(4 * bgr.total());
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u) {
      const auto& c = bgr.at<cv::Vec3b>(v, u);
      picture.rgba.insert(picture.rgba.end(), {c[2], c[1], c[0], 255});
    }
  return picture;
}

}  // namespace orcart
