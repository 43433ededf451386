// What one picture shows of the calibration board.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "realtime/base/result.hpp"
#include "tools/calibration/pattern.hpp"

namespace orcart {

struct BoardCorner {
  Eigen::Vector2i lattice = Eigen::Vector2i::Zero();  ///< column and row
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();
  Eigen::Vector3d board_mm = Eigen::Vector3d::Zero();
};

/// How surely the corners' numbers belong to the same corners in every picture. A free pose needs none of it;
/// hand-eye does.
enum class Anchor {
  none,          ///< a part of the board, anywhere on it
  half_turn,     ///< the whole board, but it looks the same upside down
  quarter_turn,  ///< the same, and on its sides too: as many columns as rows
  sure,          ///< markers, coloured dots, or a whole board that has an upper side
};

struct BoardView {
  std::filesystem::path image;
  int width_px = 0, height_px = 0;
  std::vector<BoardCorner> corners;
  Anchor anchor = Anchor::none;
  bool coloured = false;      ///< numbered from coloured dots, which need not lie at the board's first corner
  int columns = 0, rows = 0;  ///< extent of what is seen, in corners
  std::string remark;         ///< why there are no corners, or what was special
};

/// Looks for the pattern in a picture (8 bit, BGR). Without a board the view has no corners and a remark. Any
/// thread may call.
BoardView find_board(const cv::Mat& picture, const Pattern& pattern);

}  // namespace orcart
