// OpenCV's reader; it throws where a header asks for more pixels than it gives.
#include "tools/calibration/load_picture.hpp"

#include <opencv2/imgcodecs.hpp>

namespace orcart {

cv::Mat load_picture(const std::filesystem::path& file) {
  try {
    return cv::imread(file.string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace orcart
