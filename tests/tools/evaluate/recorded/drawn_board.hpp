// A lit chessboard as a camera with a known lens sees it.
#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "tools/calibration/board_view.hpp"
#include "tools/evaluate/recorded/flat_painting.hpp"

namespace orcart::testing {

struct DrawnBoard {
  int columns = 12, rows = 10;  ///< inner corners, (0, 0) at M's origin
  double square_mm = 2, gain = 1;
  double lit_from_mm = 0;  ///< light of 1 at this distance, falling with its square; 0: even light
};

inline ScopeModel board_scope() {
  ScopeModel scope{.name = "drawn", .width_px = 640, .height_px = 480};
  scope.lens = {.fx_px = 500, .fy_px = 460, .cx_px = 322, .cy_px = 238};
  scope.lens.coefficients = {-0.2, 0.05, 0.001, -0.0007, 0};
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.2);
  scope.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 235, .soft_edge_px = 2};
  scope.cone_half_angle_rad = 0.55;
  return scope;
}

/// The camera `distance_mm` before the board's middle, tilted about x and y.
inline Pose<M, C> camera_before(const DrawnBoard& board, double distance_mm, const Eigen::Vector2d& tilt) {
  Pose<M, C> X_MC;
  X_MC.rotation = (Eigen::AngleAxisd(tilt.x(), Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(tilt.y(), Eigen::Vector3d::UnitY()))
                      .toRotationMatrix();
  const Eigen::Vector3d middle(0.5 * (board.columns - 1) * board.square_mm,
                               0.5 * (board.rows - 1) * board.square_mm, 0);
  X_MC.translation_mm = middle - distance_mm * X_MC.rotation.col(2);
  return X_MC;
}

/// Linear brightness of a place of the board: ink 0.02, paper 0.7.
inline double reflectance(const DrawnBoard& board, const Eigen::Vector2d& mm) {
  const int column = static_cast<int>(std::floor(mm.x() / board.square_mm)) + 1,
            row = static_cast<int>(std::floor(mm.y() / board.square_mm)) + 1;
  const bool on_board = column >= 0 && row >= 0 && column <= board.columns && row <= board.rows;
  return on_board && (column + row) % 2 == 0 ? 0.02 : 0.7;
}

/// 16 samples a pixel; display power 1 / 2.2.
inline Picture drawn(const DrawnBoard& board, const ScopeModel& scope, const Pose<M, C>& X_MC) {
  Picture picture{.width_px = scope.width_px, .height_px = scope.height_px, .rgba = {}};
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x) {
      double sum = 0;
      for (int s = 0; s < 16; ++s) {
        const int column = s % 4, row = s / 4;
        const auto direction = direction_of(scope.lens, {x - 0.375 + 0.25 * column, y - 0.375 + 0.25 * row});
        if (!direction) continue;
        const Eigen::Vector3d ray = X_MC.rotation * *direction;
        const double distance = -X_MC.translation_mm.z() / ray.z();
        if (!(distance > 0)) continue;
        const double nearness = board.lit_from_mm > 0 ? board.lit_from_mm / distance : 1;
        sum += reflectance(board, (X_MC.translation_mm + distance * ray).head<2>()) * nearness * nearness;
      }
      const double shown = std::pow(std::min(1.0, board.gain * sum / 16), 1 / 2.2);
      const auto grey = static_cast<std::uint8_t>(std::lround(255 * shown));
      picture.rgba.insert(picture.rgba.end(), {grey, grey, grey, 255});
    }
  return picture;
}

/// The corners inside the mask, exact.
inline BoardView true_view(const DrawnBoard& board, const ScopeModel& scope, const Pose<M, C>& X_MC) {
  BoardView view{
      .image = "drawn.png", .width_px = scope.width_px, .height_px = scope.height_px, .anchor = Anchor::sure};
  for (int j = 0; j < board.rows; ++j)
    for (int i = 0; i < board.columns; ++i) {
      const Eigen::Vector3d place(i * board.square_mm, j * board.square_mm, 0);
      const auto pixel = project(scope.lens, X_MC.rotation.transpose() * (place - X_MC.translation_mm));
      if (!pixel) continue;
      const Eigen::Vector2d off(pixel->x() - scope.mask.cx_px,
                                (pixel->y() - scope.mask.cy_px) * scope.lens.fx_px / scope.lens.fy_px);
      if (off.norm() < scope.mask.radius_px - 12)
        view.corners.push_back({.lattice = {i, j}, .pixel_px = *pixel, .board_mm = place});
    }
  return view;
}

}  // namespace orcart::testing
