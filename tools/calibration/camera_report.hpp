// The answer of `orcart calibrate camera` as text, as JSON and as one page with pictures.
#pragma once

#include <string>

#include "tools/calibration/camera_command.hpp"

namespace orcart {

std::string camera_text(const CameraCalibration& calibration);
std::string camera_json(const CameraCalibration& calibration);
/// One self-contained HTML page: the board found in each picture with its residuals, coverage, residuals
/// against radius.
Result<std::string> camera_page(const CameraCalibration& calibration);

/// A JPEG as a data URL, so that a page needs no other file.
std::string picture_url(const cv::Mat& picture);

}  // namespace orcart
