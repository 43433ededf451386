// OpenCV's reader; it throws where a header asks for more pixels than it gives, and writes a warning of its
// own on stderr where there is no file.
#include "tools/calibration/load_picture.hpp"

#include <system_error>

#include <opencv2/imgcodecs.hpp>

namespace orcart {

cv::Mat load_picture(const std::filesystem::path& file) {
  std::error_code unseen;
  if (!std::filesystem::is_regular_file(file, unseen)) return {};
  try {
    return cv::imread(file.string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace orcart
