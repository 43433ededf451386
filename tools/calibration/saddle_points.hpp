// Finds the points of a picture at which four sectors meet, dark and bright by turns: a chessboard's inner
// corners.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace orcart {

/// A candidate for a corner (saddle) or a dot. Angles in radians.
struct LatticePoint {
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  double strength = 0;
  bool oriented = false;              ///< dots have no edges
  double bright_axis_rad = 0;         ///< of the two bright sectors, modulo pi
  std::array<double, 2> edges_rad{};  ///< the two lines between the sectors, modulo pi
};

struct SaddleSearch {
  double sigma_px = 2;        ///< of the smoothing; squares should be at least four times as wide
  double least_contrast = 4;  ///< grey levels between the sectors and their mean
};

/// Saddles of a grey picture (CV_32F, 0..255), strongest first, at most 20,000. Their places are good to
/// about half a pixel.
std::vector<LatticePoint> find_saddles(const cv::Mat& grey, const SaddleSearch& search);

/// The sectors around one place of the smoothed picture, or nothing where there are not four of them.
std::optional<LatticePoint> sectors_at(const cv::Mat& smoothed, const Eigen::Vector2d& place_px,
                                       double radius_px, double least_contrast);

}  // namespace orcart
