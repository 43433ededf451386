// Grids of round dots: blobs of either colour, a lattice over their centres.
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/find_board.hpp"
#include "tools/calibration/lattice_sides.hpp"

namespace orcart {
namespace {

/// Round blobs of a black and white picture; their centre is weighed by the grey picture's distance from the
/// paper.
std::vector<LatticePoint> round_blobs(const cv::Mat& binary) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(binary, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::vector<LatticePoint> blobs;
  for (const auto& outline : outlines) {
    const double area = cv::contourArea(outline), around = cv::arcLength(outline, true);
    if (area < 9 || area > 0.02 * binary.total() || 4 * std::numbers::pi * area < 0.55 * around * around)
      continue;
    const cv::Moments m = cv::moments(outline);
    blobs.push_back({.pixel_px = {m.m10 / m.m00, m.m01 / m.m00}, .strength = area});
  }
  return blobs;
}

/// The grey centre of mass of a dot, within a circle that reaches half way to its neighbours.
Eigen::Vector2d centre_of(const cv::Mat& grey, const Eigen::Vector2d& start, double reach, double sign) {
  Eigen::Vector2d centre = start;
  for (int round = 0; round < 3; ++round) {
    double paper = sign > 0 ? 0 : 255, weight_sum = 0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    const int r = static_cast<int>(std::ceil(reach));
    const cv::Point at(static_cast<int>(std::lround(centre.x())), static_cast<int>(std::lround(centre.y())));
    if (!cv::Rect(r, r, grey.cols - 2 * r, grey.rows - 2 * r).contains(at)) return start;
    double on_rim = 0;
    int rim = 0;
    const auto walk = [&](auto&& visit) {
      for (int y = at.y - r; y <= at.y + r; ++y)
        for (int x = at.x - r; x <= at.x + r; ++x) visit(x, y, (Eigen::Vector2d(x, y) - centre).norm());
    };
    walk([&](int x, int y, double distance) {
      if (std::abs(distance - reach) < 1) on_rim += grey.at<float>(y, x), ++rim;
    });
    if (rim == 0) return start;
    paper = on_rim / rim;
    walk([&](int x, int y, double distance) {
      const double weight =
          std::max(0.0, sign * (grey.at<float>(y, x) - paper)) * std::clamp(reach - distance, 0.0, 1.0);
      weight_sum += weight;
      sum += weight * Eigen::Vector2d(x, y);
    });
    if (weight_sum <= 0) return start;
    centre = sum / weight_sum;
  }
  return (centre - start).norm() < 0.5 * reach ? centre : start;
}

void refine(const cv::Mat& grey, double sign, Lattice& lattice) {
  const Lattice before = lattice;
  for (auto& [place, pixel] : lattice) {
    double step = 1e9;
    for (const auto& to : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      const auto next = before.find({place.first + to.first, place.second + to.second});
      if (next != before.end()) step = std::min(step, (next->second - before.at(place)).norm());
    }
    if (step < 1e9) pixel = centre_of(grey, pixel, 0.5 * step, sign);
  }
}

}  // namespace

BoardView find_dots(const cv::Mat& picture, const Pattern& pattern) {
  BoardView view;
  const cv::Mat grey = grey_of(picture);
  cv::Mat grey8, binary;
  grey.convertTo(grey8, CV_8U);
  cv::GaussianBlur(grey8, grey8, {}, 1.0);
  const auto enough = static_cast<std::size_t>(pattern.columns) * static_cast<std::size_t>(pattern.rows);
  Lattice best;
  double best_sign = -1;
  for (const double part : {0.08, 0.04, 0.16}) {
    const int block = 2 * static_cast<int>(0.5 * part * std::min(grey.cols, grey.rows)) + 1;
    for (const bool dark : {true, false}) {
      if (best.size() >= enough || block < 5) continue;
      cv::adaptiveThreshold(grey8, binary, 255, cv::ADAPTIVE_THRESH_MEAN_C,
                            dark ? cv::THRESH_BINARY_INV : cv::THRESH_BINARY, block, dark ? 6 : -6);
      Lattice lattice = grow_lattice(round_blobs(binary), enough);
      if (lattice.size() <= best.size()) continue;
      best = std::move(lattice);
      best_sign = dark ? -1 : 1;
    }
  }
  if (best.size() < 12) {
    view.remark = "no grid of dots is seen";
    return view;
  }
  count_along_sides(best, grey.size());
  refine(grey, best_sign, best);
  const LatticeSize seen = size_of(best);
  view.columns = seen.columns, view.rows = seen.rows;
  if (!fit_to_pattern(best, pattern)) {
    view.remark = "a grid of at least " + std::to_string(std::max(seen.columns, seen.rows)) + "x" +
                  std::to_string(std::min(seen.columns, seen.rows)) + " dots is seen, more than " +
                  text_of(pattern) + " has";
    return view;
  }
  const LatticeSize size = size_of(best);
  view.columns = size.columns, view.rows = size.rows;
  if (size.columns == pattern.columns && size.rows == pattern.rows) {
    view.anchor = size.columns == size.rows ? Anchor::quarter_turn : Anchor::half_turn;
  } else {
    view.remark = "a part of the grid: " + std::to_string(size.columns) + "x" + std::to_string(size.rows);
  }
  view.corners = corners_of(best, pattern);
  return view;
}

}  // namespace orcart
