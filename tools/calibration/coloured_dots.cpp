// Finds a yellow dot beside a red and a green one, at right angles, by the colour in the middle of each
// square.
#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/find_board.hpp"

namespace orcart {
namespace {

/// How red, yellow and green a square's middle is, 0..1; grey and white are none of them.
struct Hues {
  double red = 0, yellow = 0, green = 0;
};

Hues hues_of(const cv::Scalar& bgr) {
  const double b = bgr[0], g = bgr[1], r = bgr[2], most = std::max({b, g, r});
  if (most < 40) return {};
  return {.red = (r - std::max(g, b)) / most,
          .yellow = (std::min(r, g) - b) / most - std::abs(r - g) / most,
          .green = (g - std::max(r, b)) / most};
}

using Squares = std::map<std::pair<int, int>, Hues>;

/// Corners that were not found (a dot may touch them) are taken from where their neighbours expect them.
Squares squares_of(const cv::Mat& picture, const Lattice& lattice) {
  Squares squares;
  const LatticeSize size = size_of(lattice);
  const auto corner = [&lattice](int i, int j) -> std::optional<Eigen::Vector2d> {
    const auto node = lattice.find({i, j});
    if (node != lattice.end()) return node->second;
    return predicted(lattice, {i, j});
  };
  for (int j = size.first_row; j < size.first_row + size.rows - 1; ++j)
    for (int i = size.first_column; i < size.first_column + size.columns - 1; ++i) {
      const std::array around{corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)};
      if (!std::all_of(around.begin(), around.end(), [](const auto& c) { return c.has_value(); })) continue;
      const Eigen::Vector2d middle = 0.25 * (*around[0] + *around[1] + *around[2] + *around[3]);
      const double side = std::min((*around[1] - *around[0]).norm(), (*around[2] - *around[0]).norm());
      const int reach = std::max(1, static_cast<int>(0.15 * side));
      const cv::Rect box = cv::Rect(static_cast<int>(middle.x()) - reach,
                                    static_cast<int>(middle.y()) - reach, 2 * reach + 1, 2 * reach + 1) &
                           cv::Rect(0, 0, picture.cols, picture.rows);
      if (box.area() >= 4) squares[{i, j}] = hues_of(cv::mean(picture(box)));
    }
  return squares;
}

}  // namespace

std::optional<ColouredDots> find_coloured_dots(const cv::Mat& picture, const Lattice& lattice) {
  if (picture.channels() != 3) return std::nullopt;
  constexpr double kLeastColour = 0.12;
  const Squares squares = squares_of(picture, lattice);
  std::optional<ColouredDots> best;
  double best_score = 0;
  for (const auto& [place, hues] : squares) {
    if (hues.yellow < kLeastColour) continue;
    for (const auto& x : std::array<Eigen::Vector2i, 4>{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}}) {
      const Eigen::Vector2i y(-x.y(), x.x());
      const auto red = squares.find({place.first + x.x(), place.second + x.y()});
      const auto green = squares.find({place.first + y.x(), place.second + y.y()});
      if (red == squares.end() || green == squares.end() || red->second.red < kLeastColour ||
          green->second.green < kLeastColour)
        continue;
      const double score = hues.yellow * red->second.red * green->second.green;
      if (score <= best_score) continue;
      best_score = score;
      const Eigen::Vector2i origin(place.first, place.second);
      best = ColouredDots{.origin = origin, .along_x = origin + x, .along_y = origin + y};
    }
  }
  return best;
}

}  // namespace orcart
