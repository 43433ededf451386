// The three detectors behind find_board().
#pragma once

#include <optional>

#include "tools/calibration/board_view.hpp"
#include "tools/calibration/lattice.hpp"

namespace orcart {

BoardView find_chessboard(const cv::Mat& picture, const Pattern& pattern);
BoardView find_charuco(const cv::Mat& picture, const Pattern& pattern);
BoardView find_dots(const cv::Mat& picture, const Pattern& pattern);

/// The grey picture, CV_32F, 0..255.
cv::Mat grey_of(const cv::Mat& picture);

/// The lattice's corners at the pattern's places.
std::vector<BoardCorner> corners_of(const Lattice& lattice, const Pattern& pattern);

/// Takes border lines off a lattice that is larger than the pattern, where they hold few corners; turns it so
/// that its long side lies along the pattern's. False where it stays larger than the pattern.
bool fit_to_pattern(Lattice& lattice, const Pattern& pattern);

/// Red, yellow and green dots on a chessboard: yellow in the square of the origin, red in its neighbour along
/// x, green in its neighbour along y (columns and rows of the lattice's squares, each named by its upper left
/// corner).
struct ColouredDots {
  Eigen::Vector2i origin, along_x, along_y;
};
std::optional<ColouredDots> find_coloured_dots(const cv::Mat& picture, const Lattice& lattice);

}  // namespace orcart
