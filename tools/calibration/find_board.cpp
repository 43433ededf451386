// Chooses the detector, and what the three have in common.
#include "tools/calibration/find_board.hpp"

#include <opencv2/imgproc.hpp>

namespace orcart {
namespace {

/// Corners in each column (or row) of the lattice.
std::map<int, int> line_counts(const Lattice& lattice, bool columns) {
  std::map<int, int> counts;
  for (const auto& [place, unused] : lattice) ++counts[columns ? place.first : place.second];
  return counts;
}

/// Takes the weaker of the two outer lines off while there are more than `most`; a well filled one is part of
/// the board.
bool trim(Lattice& lattice, bool columns, int most) {
  for (;;) {
    const auto counts = line_counts(lattice, columns);
    if (static_cast<int>(counts.size()) <= most) return true;
    const auto first = *counts.begin(), last = *counts.rbegin();
    const auto weaker = first.second <= last.second ? first : last;
    const double mean = static_cast<double>(lattice.size()) / static_cast<double>(counts.size());
    if (weaker.second > 0.6 * mean) return false;
    std::erase_if(lattice, [&](const auto& node) {
      return (columns ? node.first.first : node.first.second) == weaker.first;
    });
  }
}

bool trim_both(Lattice& lattice, int columns, int rows) {
  return trim(lattice, true, columns) && trim(lattice, false, rows);
}

}  // namespace

cv::Mat grey_of(const cv::Mat& picture) {
  cv::Mat grey, result;
  if (picture.channels() == 3) {
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = picture;
  }
  grey.convertTo(result, CV_32F);
  return result;
}

std::vector<BoardCorner> corners_of(const Lattice& lattice, const Pattern& pattern) {
  std::vector<BoardCorner> corners;
  for (const auto& [place, pixel] : lattice) {
    const Eigen::Vector2i at(place.first, place.second);
    corners.push_back({.lattice = at, .pixel_px = pixel, .board_mm = pattern.place_mm(at)});
  }
  return corners;
}

bool fit_to_pattern(Lattice& lattice, const Pattern& pattern) {
  const int columns = pattern.corner_columns(), rows = pattern.corner_rows();
  Lattice upright = lattice, turned_once = turned(lattice, 1);
  const bool fits = trim_both(upright, columns, rows), fits_turned = trim_both(turned_once, columns, rows);
  if (!fits && !fits_turned) return false;
  const auto closeness = [&](const Lattice& one) {
    const LatticeSize size = size_of(one);
    return std::pair(one.size(), std::pair((size.columns == columns) + (size.rows == rows), size.columns));
  };
  const bool turn = !fits || (fits_turned && closeness(turned_once) > closeness(upright));
  lattice = turned(turn ? turned_once : upright, 0);
  return true;
}

BoardView find_board(const cv::Mat& picture, const Pattern& pattern) {
  BoardView view;
  switch (pattern.kind) {
    case PatternKind::chessboard:
      view = find_chessboard(picture, pattern);
      break;
    case PatternKind::charuco:
      view = find_charuco(picture, pattern);
      break;
    case PatternKind::dots:
      view = find_dots(picture, pattern);
      break;
  }
  view.width_px = picture.cols;
  view.height_px = picture.rows;
  return view;
}

}  // namespace orcart
