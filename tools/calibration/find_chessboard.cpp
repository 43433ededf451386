// Chessboards, whole or in part: saddles, a lattice over them, places to a hundredth of a pixel, and the
// board's upper side.
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/find_board.hpp"

namespace orcart {
namespace {

/// The shortest step from a corner to a neighbour, px; 0 where it has none.
double least_step(const Lattice& lattice, std::pair<int, int> place) {
  double least = 1e9;
  for (const auto& step : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    const auto next = lattice.find({place.first + step.first, place.second + step.second});
    if (next != lattice.end()) least = std::min(least, (next->second - lattice.at(place)).norm());
  }
  return least < 1e9 ? least : 0;
}

/// Sub-pixel places; a corner that runs away from its start is dropped.
void refine(const cv::Mat& grey8, Lattice& lattice) {
  Lattice refined;
  for (const auto& [place, pixel] : lattice) {
    const double step = least_step(lattice, place);
    const int window = std::clamp(static_cast<int>(0.3 * step), 2, 11);
    std::vector<cv::Point2f> point{{static_cast<float>(pixel.x()), static_cast<float>(pixel.y())}};
    cv::cornerSubPix(grey8, point, {window, window}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
    const Eigen::Vector2d found(point[0].x, point[0].y);
    if ((found - pixel).norm() < std::max(1.5, 0.15 * step)) refined[place] = found;
  }
  lattice = std::move(refined);
  prune(lattice);
}

/// Corners that were too faint for the search but lie where their neighbours expect them.
void fill(const cv::Mat& smoothed, const cv::Mat& grey8, Lattice& lattice, const LatticeSize& most) {
  for (int round = 0; round < 6; ++round) {
    Lattice added;
    const LatticeSize size = size_of(lattice);
    const int beyond_x = size.columns < most.columns ? 1 : 0, beyond_y = size.rows < most.rows ? 1 : 0;
    for (int j = size.first_row - beyond_y; j < size.first_row + size.rows + beyond_y; ++j)
      for (int i = size.first_column - beyond_x; i < size.first_column + size.columns + beyond_x; ++i) {
        if (lattice.contains({i, j})) continue;
        const auto expected = predicted(lattice, {i, j});
        if (!expected ||
            !cv::Rect(3, 3, grey8.cols - 6, grey8.rows - 6).contains(cv::Point(expected->x(), expected->y())))
          continue;
        Lattice tried = lattice;
        tried[{i, j}] = *expected;
        const double step = least_step(tried, {i, j});
        if (step < 4) continue;
        const int window = std::clamp(static_cast<int>(0.3 * step), 2, 11);
        std::vector<cv::Point2f> point{
            {static_cast<float>(expected->x()), static_cast<float>(expected->y())}};
        cv::cornerSubPix(grey8, point, {window, window}, {-1, -1},
                         {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
        const Eigen::Vector2d found(point[0].x, point[0].y);
        if ((found - *expected).norm() > 0.15 * step) continue;
        const auto sectors = sectors_at(smoothed, found, std::max(2.5, 0.25 * step), 2.5);
        if (sectors) added[{i, j}] = found;
      }
    if (added.empty()) return;
    lattice.insert(added.begin(), added.end());
    prune(lattice);
  }
}

/// Whether squares (i, j) with i + j even are the bright ones: from squares against their neighbours.
bool even_squares_bright(const cv::Mat& smoothed, const Lattice& lattice) {
  double sum = 0;
  for (const auto& [place, pixel] : lattice) {
    const auto right = lattice.find({place.first + 1, place.second}),
               down = lattice.find({place.first, place.second + 1}),
               across = lattice.find({place.first + 1, place.second + 1});
    if (right == lattice.end() || down == lattice.end() || across == lattice.end()) continue;
    const Eigen::Vector2d middle = 0.25 * (pixel + right->second + down->second + across->second);
    const Eigen::Vector2d left = middle - (right->second - pixel), up = middle - (down->second - pixel);
    const auto at = [&smoothed](const Eigen::Vector2d& p) {
      const int x = std::clamp(static_cast<int>(std::lround(p.x())), 0, smoothed.cols - 1);
      const int y = std::clamp(static_cast<int>(std::lround(p.y())), 0, smoothed.rows - 1);
      return static_cast<double>(smoothed.at<float>(y, x));
    };
    const double difference = at(middle) - 0.5 * (at(left) + at(up));
    sum += ((place.first + place.second) % 2 == 0 ? 1 : -1) * std::copysign(1.0, difference);
  }
  return sum > 0;
}

/// Renumbers a lattice from coloured dots: corners by their distance from the middle of the yellow square, in
/// half squares.
std::vector<BoardCorner> anchored(const Lattice& lattice, const ColouredDots& dots, const Pattern& pattern) {
  const Eigen::Vector2i x = dots.along_x - dots.origin, y = dots.along_y - dots.origin;
  std::vector<BoardCorner> corners;
  for (const auto& [place, pixel] : lattice) {
    const Eigen::Vector2i twice =
        2 * (Eigen::Vector2i(place.first, place.second) - dots.origin) - Eigen::Vector2i(1, 1);
    const Eigen::Vector2i half(twice.dot(x), twice.dot(y));
    corners.push_back(
        {.lattice = {(half.x() + 1) / 2, (half.y() + 1) / 2},
         .pixel_px = pixel,
         .board_mm = {0.5 * half.x() * pattern.spacing_mm, 0.5 * half.y() * pattern.spacing_mm, 0}});
    corners.back().lattice = {static_cast<int>(std::floor(0.5 * half.x())) + 1,
                              static_cast<int>(std::floor(0.5 * half.y())) + 1};
  }
  return corners;
}

/// A whole board: its upper side is where the square before the first corner is dark, where that can be told.
Anchor anchor_whole(const cv::Mat& smoothed, Lattice& lattice, const Pattern& pattern) {
  const bool square = pattern.columns == pattern.rows;
  if ((pattern.columns + pattern.rows) % 2 == 0) {
    // With an even number of corners a side all four corner squares are of one colour.
    if (square && pattern.columns % 2 == 0) return Anchor::quarter_turn;
    if (square && even_squares_bright(smoothed, lattice)) lattice = turned(lattice, 1);
    return Anchor::half_turn;
  }
  // The square before (0, 0) has an even sum, as has the one at (0, 0).
  if (even_squares_bright(smoothed, lattice)) lattice = turned(lattice, 2);
  return Anchor::sure;
}

Lattice best_lattice(const cv::Mat& grey, std::size_t enough) {
  Lattice best;
  for (const double sigma : {2.0, 1.2, 3.5, 5.0}) {
    if (sigma > 3 && std::min(grey.cols, grey.rows) < 300) continue;
    Lattice lattice = grow_lattice(find_saddles(grey, {.sigma_px = sigma}), enough);
    if (lattice.size() > best.size()) best = std::move(lattice);
    if (best.size() >= enough) break;
  }
  return best;
}

}  // namespace

BoardView find_chessboard(const cv::Mat& picture, const Pattern& pattern) {
  BoardView view;
  const cv::Mat grey = grey_of(picture);
  cv::Mat grey8, smoothed;
  grey.convertTo(grey8, CV_8U);
  cv::GaussianBlur(grey, smoothed, {}, 1.5);
  Lattice lattice =
      best_lattice(grey, static_cast<std::size_t>(pattern.columns) * static_cast<std::size_t>(pattern.rows));
  if (!lattice.empty()) refine(grey8, lattice);
  const int longest = std::max(pattern.columns, pattern.rows);
  fill(smoothed, grey8, lattice, {.columns = longest, .rows = longest});
  if (lattice.size() < 12) {
    view.remark = "no chessboard is seen";
    return view;
  }
  const LatticeSize seen = size_of(lattice);
  view.columns = seen.columns, view.rows = seen.rows;
  if (!fit_to_pattern(lattice, pattern)) {
    view.remark = "a chessboard of at least " + std::to_string(std::max(seen.columns, seen.rows)) + "x" +
                  std::to_string(std::min(seen.columns, seen.rows)) + " inner corners is seen, more than " +
                  text_of(pattern) + " has";
    return view;
  }
  const LatticeSize size = size_of(lattice);
  view.columns = size.columns, view.rows = size.rows;
  if (const auto dots = find_coloured_dots(picture, lattice)) {
    view.corners = anchored(lattice, *dots, pattern);
    view.anchor = Anchor::sure;
    view.coloured = true;
    view.remark = "anchored by coloured dots";
    return view;
  }
  if (size.columns == pattern.columns && size.rows == pattern.rows)
    view.anchor = anchor_whole(smoothed, lattice, pattern);
  view.corners = corners_of(lattice, pattern);
  if (view.anchor == Anchor::none)
    view.remark = "a part of the board: " + std::to_string(size.columns) + "x" + std::to_string(size.rows);
  return view;
}

}  // namespace orcart
