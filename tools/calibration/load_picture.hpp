// A picture file as the sensor saw it.
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

namespace orcart {

/// Three channels of 8 bits; empty where the file is no picture that can be read. A turn that EXIF asks for
/// is left alone, as in the rest of the cart: lens and mask belong to the sensor, however the camera was
/// held.
cv::Mat load_picture(const std::filesystem::path& file);

}  // namespace orcart
