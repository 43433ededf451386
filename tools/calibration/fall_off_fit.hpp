// Estimates from the board's white paper how brightness falls towards the edge of the view.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_solver.hpp"

namespace orcart {

/// A patch of white paper: natural logarithm of its linear brightness (2.2 gamma undone) with what distance
/// and the paper's slant do taken off, and the logarithm of the cosine of its angle off the axis.
struct PaperPatch {
  std::size_t view = 0;
  double log_brightness = 0;
  double log_cosine = 0;
};

/// The patches between the corners of one view; clipped and dark ones are left out.
std::vector<PaperPatch> paper_patches(const cv::Mat& picture, const BoardView& view, const ViewFit& fit,
                                      const Lens& lens, std::size_t number);

/// The exponent of the cosine, each view with a gain of its own (cameras set their exposure themselves).
/// Nothing where the patches are too few or all at one angle.
std::optional<double> vignetting_power(const std::vector<PaperPatch>& patches, std::size_t views);

}  // namespace orcart
