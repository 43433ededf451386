// Drawn at half the painting's size.
#include "tools/evaluate/recorded/board_pictures.hpp"

#include <opencv2/imgproc.hpp>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr double kScale = 0.5;

cv::Mat smaller(const cv::Mat& bgr) {
  cv::Mat small;
  cv::resize(bgr, small, {}, kScale, kScale, cv::INTER_AREA);
  return small;
}

cv::Point on_small(const FlatPainting& flat, const Eigen::Vector2d& place_mm) {
  const cv::Point2f pixel = flat.pixel_of(place_mm);
  return {static_cast<int>(kScale * static_cast<double>(pixel.x)),
          static_cast<int>(kScale * static_cast<double>(pixel.y))};
}

std::string file_name(const std::string& words) {
  std::string name;
  for (const char c : words) name += c == ' ' || c == '.' || c == '/' ? '-' : c;
  return name + ".png";
}

}  // namespace

CaptionedPicture annotated(const ViewMapping& view) {
  cv::Mat small = smaller(view.flat.bgr);
  const cv::Scalar green(60, 200, 60), red(40, 40, 230);
  for (const PaintedCorner& corner : view.corners) {
    const cv::Point printed = on_small(view.flat, corner.grid_mm);
    cv::circle(small, printed, 3, green, 1, cv::LINE_AA);
    cv::line(small, printed, on_small(view.flat, corner.found_mm), red, 2, cv::LINE_AA);
  }
  return {
      .name = file_name("mapping " + view.image),
      .caption = view.image + json::format(": %zu of %zu corners found again, mean %.2f, max %.2f mm",
                                           view.corners.size(), view.seen, view.error.mean, view.error.max),
      .picture = picture_of(small)};
}

CaptionedPicture joined(const FlatPainting& together, const std::string& light, const LightStep& step) {
  return {.name = file_name("joined " + light),
          .caption = "All views, the newest last; light: " + light +
                     json::format(". Step across the joins: mean %.1f of 255 grey levels (%.0f %%).",
                                  step.grey.mean, step.percent),
          .picture = picture_of(smaller(together.bgr))};
}

}  // namespace orcart
