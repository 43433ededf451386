// Views of a board through a known lens, as corners without pictures.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "tools/calibration/camera_solver.hpp"

namespace orcart::testing {

inline Lens test_lens(LensModel model) {
  Lens lens{.model = model, .fx_px = 410, .fy_px = 375, .cx_px = 322, .cy_px = 250};
  if (model == LensModel::brown) lens.coefficients = {-0.32, 0.11, 0.001, -0.0007, -0.01};
  if (model == LensModel::fisheye) lens.coefficients = {-0.03, 0.01, -0.004, 0.001, 0};
  if (model == LensModel::poly4) {
    lens.coefficients = {2e-4, 3e-7, 1e-9, 0, 0};
    lens.distortion_centre_px = {315, 246};
  }
  lens.max_angle_rad = largest_monotone_angle_rad(lens, 1.5);
  return lens;
}

struct SimulatedViews {
  int views = 10;
  double noise_px = 0;
  double tilt_rad = 0.5;
  double roll_rad = 0;  ///< about the optical axis, each way, evenly over the views
  double nearest_mm = 25, farthest_mm = 40;
};

inline Pose<C, B> board_before(double distance_mm, const Eigen::Vector3d& turn) {
  Pose<C, B> X_CB;
  X_CB.rotation = Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? Eigen::Vector3d(turn.normalized())
                                                                 : Eigen::Vector3d::UnitX())
                      .toRotationMatrix();
  X_CB.translation_mm = Eigen::Vector3d(0, 0, distance_mm) - X_CB.rotation * Eigen::Vector3d(13, 9, 0);
  return X_CB;
}

/// A 14x10 board of 2 mm before a 640x480 camera. `poses`, where given, takes the truth.
inline std::vector<BoardView> simulated_views(const Lens& lens, const SimulatedViews& task,
                                              std::vector<Pose<C, B>>* poses = nullptr) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<BoardView> views;
  for (int v = 0; v < task.views; ++v) {
    const Eigen::Vector3d turn(task.tilt_rad * any(random), task.tilt_rad * any(random), 0.4 * any(random));
    const double part = static_cast<double>(v) / std::max(1, task.views - 1);
    Pose<C, C> roll;
    roll.rotation =
        Eigen::AngleAxisd(task.roll_rad * (4 * std::abs(part - 0.5) - 1), Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const Pose<C, B> X_CB =
        roll * board_before(task.nearest_mm + (task.farthest_mm - task.nearest_mm) * part, turn);
    BoardView view{.image = "view" + std::to_string(v),
                   .width_px = 640,
                   .height_px = 480,
                   .anchor = Anchor::sure,
                   .columns = 14,
                   .rows = 10};
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 14; ++i) {
        const Eigen::Vector3d place(2.0 * i, 2.0 * j, 0);
        const auto pixel = project(lens, (X_CB * Point<B>{place}).mm);
        if (!pixel) continue;
        view.corners.push_back(
            {.lattice = {i, j},
             .pixel_px = *pixel + task.noise_px * Eigen::Vector2d(noise(random), noise(random)),
             .board_mm = place});
      }
    if (poses != nullptr) poses->push_back(X_CB);
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace orcart::testing
