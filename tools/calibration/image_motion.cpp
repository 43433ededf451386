// OpenCV finds and follows; the lens turns pixels into directions.
#include "tools/calibration/image_motion.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "tools/calibration/board_pose.hpp"

namespace orcart {
namespace {

constexpr std::size_t kMostFeatures = 120, kLongestPath = 90;
constexpr int kApart_px = 10;
constexpr double kThereAndBack_px = 0.5;

/// White where features may be looked for: inside the mask, away from its edge and from highlights.
cv::Mat usable(const cv::Mat& grey, const ScopeModel& scope) {
  cv::Mat dark_edge(grey.size(), CV_8U, cv::Scalar(0)), bright;
  const CircularMask& m = scope.mask;
  const double margin = 0.9 * m.radius_px;
  cv::ellipse(dark_edge, cv::Point2d(m.cx_px, m.cy_px),
              cv::Size2d(margin, margin * scope.lens.fy_px / scope.lens.fx_px), 0, 0, 360, cv::Scalar(255),
              cv::FILLED);
  cv::threshold(grey, bright, 230, 255, cv::THRESH_BINARY);
  cv::dilate(bright, bright, cv::getStructuringElement(cv::MORPH_RECT, {9, 9}));
  dark_edge.setTo(cv::Scalar(0), bright);
  return dark_edge;
}

std::optional<Eigen::Vector2d> flat(const Lens& lens, const cv::Point2f& pixel) {
  const auto direction = direction_of(lens, {pixel.x, pixel.y});
  if (!direction || direction->z() < 0.2) return std::nullopt;
  return Eigen::Vector2d(direction->head<2>() / direction->z());
}

}  // namespace

std::optional<SeenBoard> sight_of_board(const cv::Mat& picture, double at_s, const Pattern& pattern,
                                        const ScopeModel& scope) {
  const BoardView view = find_board(picture, pattern);
  if (view.corners.empty() || view.anchor == Anchor::none) return std::nullopt;
  const auto X_CB = board_pose(view, scope.lens);
  if (!X_CB) return std::nullopt;
  const Pose<B, C> X_BC = X_CB->inverse();
  return SeenBoard{.sight = {.at_s = at_s,
                             .marker_mm = (X_BC * scope.X_SC.inverse()).translation_mm,
                             .camera_mm = X_BC.translation_mm},
                   .anchor = view.anchor,
                   .coloured = view.coloured};
}

std::vector<BoardSight> settled(const std::vector<std::optional<SeenBoard>>& seen, const Pattern& pattern) {
  const bool dotted = std::ranges::any_of(seen, [](const auto& one) { return one && one->coloured; });
  std::vector<BoardSight> sights;
  for (const auto& one : seen) {
    if (!one || (dotted && !one->coloured)) continue;
    BoardSight best = one->sight;
    for (const int turns : turns_alike(one->anchor)) {
      if (sights.empty()) break;
      const Pose<B, B> back = turned_about_middle(pattern, turns).inverse();
      const BoardSight other{.at_s = best.at_s,
                             .marker_mm = (back * Point<B>{one->sight.marker_mm}).mm,
                             .camera_mm = (back * Point<B>{one->sight.camera_mm}).mm};
      const Eigen::Vector3d& last = sights.back().marker_mm;
      if ((other.marker_mm - last).norm() < (best.marker_mm - last).norm()) best = other;
    }
    sights.push_back(best);
  }
  return sights;
}

void FeatureFollower::look(const cv::Mat& picture, std::size_t frame) {
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  followed_ = 0;
  if (!last_.empty() && !open_.empty()) follow(grey, frame);
  replenish(grey, frame);
  last_ = grey;
}

void FeatureFollower::interrupt() {
  for (Open& one : open_) end(one);
  open_.clear();
  last_.release();
}

std::vector<FeaturePath> FeatureFollower::paths() {
  interrupt();
  return std::move(ended_);
}

void FeatureFollower::end(Open& one) {
  if (one.path.size() > 1) ended_.push_back(std::move(one.path));
}

void FeatureFollower::follow(const cv::Mat& grey, std::size_t frame) {
  std::vector<cv::Point2f> first, second, back;
  for (const Open& one : open_) first.push_back(one.pixel);
  std::vector<uchar> there, returned;
  const cv::Size window(21, 21);
  cv::calcOpticalFlowPyrLK(last_, grey, first, second, there, cv::noArray(), window, 4);
  cv::calcOpticalFlowPyrLK(grey, last_, second, back, returned, cv::noArray(), window, 4);
  const cv::Mat usable_here = usable(grey, scope_);
  std::vector<Open> going_on;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const cv::Rect picture(0, 0, grey.cols, grey.rows);
    const cv::Point at(cvRound(second[i].x), cvRound(second[i].y));
    const bool came_back = there[i] != 0 && returned[i] != 0 &&
                           std::hypot(back[i].x - first[i].x, back[i].y - first[i].y) <= kThereAndBack_px;
    const auto direction = came_back ? flat(scope_.lens, second[i]) : std::nullopt;
    if (!direction || !picture.contains(at) || usable_here.at<uchar>(at) == 0) {
      end(open_[i]);
      continue;
    }
    ++followed_;
    open_[i].pixel = second[i];
    open_[i].path.push_back({frame, *direction});
    if (open_[i].path.size() < kLongestPath) {
      going_on.push_back(std::move(open_[i]));
    } else {
      end(open_[i]);
    }
  }
  open_ = std::move(going_on);
}

void FeatureFollower::replenish(const cv::Mat& grey, std::size_t frame) {
  if (open_.size() > kMostFeatures * 2 / 3) return;
  cv::Mat free = usable(grey, scope_);
  for (const Open& one : open_) cv::circle(free, one.pixel, kApart_px, cv::Scalar(0), cv::FILLED);
  std::vector<cv::Point2f> found;
  cv::goodFeaturesToTrack(grey, found, static_cast<int>(kMostFeatures - open_.size()), 0.01, kApart_px, free,
                          5);
  for (const cv::Point2f& pixel : found)
    if (const auto direction = flat(scope_.lens, pixel))
      open_.push_back({.pixel = pixel, .path = {{frame, *direction}}});
}

}  // namespace orcart
