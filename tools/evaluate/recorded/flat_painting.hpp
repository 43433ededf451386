// A board's plane as a surface to paint on, and its painting as a flat picture.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/offline/offline_painter.hpp"

namespace orcart {

/// A rectangle of the plane z = 0 of M, which is the board's own frame: x along columns, y along rows, z away
/// from the camera. Whole millimetres.
struct PlaneExtent {
  Eigen::Vector2i low_mm = Eigen::Vector2i::Zero(), high_mm = Eigen::Vector2i::Zero();
  int columns() const { return high_mm.x() - low_mm.x(); }
  int rows() const { return high_mm.y() - low_mm.y(); }
};

/// Squares of 1 mm, their normals towards the camera (-z).
Surface plane_surface(const PlaneExtent& extent);

/// What lies painted on the plane: pixel (0, 0) is centred on the extent's low corner, u along x, v along y.
struct FlatPainting {
  PlaneExtent extent;
  double pixel_mm = 0.05;
  cv::Mat bgr;      ///< CV_8UC3, black where nothing is painted
  cv::Mat painted;  ///< CV_8U, 255 where all four texels about the pixel carry paint
  cv::Mat capture;  ///< CV_16U, the view that painted the pixel, from 1; 0 where there is none

  Eigen::Vector2d place_mm(const cv::Point2f& pixel) const {
    return extent.low_mm.cast<double>() + pixel_mm * Eigen::Vector2d(pixel.x, pixel.y);
  }
  cv::Point2f pixel_of(const Eigen::Vector2d& place_mm) const {
    const Eigen::Vector2d pixel = (place_mm - extent.low_mm.cast<double>()) / pixel_mm;
    return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
  }
};

/// One recorded picture and the pose it is painted from.
struct PosedPicture {
  Picture picture;
  Pose<M, C> X_MC;
};

/// Paints the pictures, the newest last, with the painter behind `orcart paint`, and flattens the atlas
/// between texel centres. Makes an OpenGL context of its own.
Result<FlatPainting> paint_plane(const PlaneExtent& extent, const ScopeModel& scope,
                                 std::vector<PosedPicture>& pictures, const OfflinePaintOptions& options);

/// The painting with its border's colours carried on by `margin_mm`, as filters do at a picture's border: the
/// black beside it is no edge of the board.
cv::Mat carried_on(const FlatPainting& painting, double margin_mm);

/// For a page or a file.
Picture picture_of(const cv::Mat& bgr);

}  // namespace orcart
