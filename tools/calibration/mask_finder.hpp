// Finds the bright circle of an endoscope's picture and the notch that says which way is up.
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "realtime/optics/scope_model.hpp"

namespace orcart {

struct FoundMask {
  CircularMask mask;
  bool circle = false;  ///< false: the picture fills its rectangle, and the mask is the circle around it
  std::optional<double> notch_rad;  ///< from x towards y, in pixels made square
};

/// `lit` is the brightest each pixel ever was (8 bit grey), `aspect` fy / fx.
FoundMask find_mask(const cv::Mat& lit, double aspect);

/// The widest angle off the axis within the mask and the picture, as far as the lens goes.
double cone_half_angle_rad(const Lens& lens, const CircularMask& mask, const Eigen::Vector2i& size_px);

/// Whether every pixel of the mask's edge inside the picture has a direction.
bool monotone_to_edge(const Lens& lens, const CircularMask& mask, const Eigen::Vector2i& size_px);

}  // namespace orcart
