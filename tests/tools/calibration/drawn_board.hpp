// Pictures of a chessboard as a scope with a known lens sees it, ray by ray.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_solver.hpp"

namespace orcart::testing {

/// Draws one board again and again; the rays are asked of the lens once.
class DrawnBoard {
 public:
  struct Look {
    int columns = 9, rows = 8;  ///< inner corners
    double square_mm = 3;
    double noise = 2;  ///< grey levels
  };
  DrawnBoard(const ScopeModel& scope, const Look& look) : scope_(scope), look_(look) {
    for (int y = 0; y < kFiner * scope.height_px; ++y)
      for (int x = 0; x < kFiner * scope.width_px; ++x) {
        const Eigen::Vector2d pixel((x + 0.5) / kFiner - 0.5, (y + 0.5) / kFiner - 0.5);
        const bool inside =
            std::hypot(pixel.x() - scope.mask.cx_px, pixel.y() - scope.mask.cy_px) < scope.mask.radius_px;
        const auto direction = inside ? direction_of(scope.lens, pixel) : std::nullopt;
        rays_.push_back(direction ? Eigen::Vector3f(direction->cast<float>()) : Eigen::Vector3f::Zero());
      }
  }

  cv::Mat seen_from(const Pose<C, B>& X_CB, unsigned seed) const {
    cv::Mat fine(kFiner * scope_.height_px, kFiner * scope_.width_px, CV_8U, cv::Scalar(4)), picture;
    const Pose<B, C> X_BC = X_CB.inverse();
    const Eigen::Matrix3f turn = X_BC.rotation.cast<float>();
    const Eigen::Vector3f eye = X_BC.translation_mm.cast<float>();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (rays_[i].isZero()) continue;
      const Eigen::Vector3f ray = turn * rays_[i];
      const float length = -eye.z() / ray.z();
      if (length > 0) fine.data[i] = grey(eye + length * ray);
    }
    cv::resize(fine, picture, {scope_.width_px, scope_.height_px}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(picture, picture, {}, 0.7);
    cv::Mat noise(picture.size(), CV_16S), sum;
    cv::RNG random(seed + 1);
    random.fill(noise, cv::RNG::NORMAL, 0, look_.noise);
    picture.convertTo(sum, CV_16S);
    sum += noise;
    sum.convertTo(picture, CV_8U);
    cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    return picture;
  }

 private:
  static constexpr int kFiner = 2;
  /// Dark squares from one before the first corner on, a white margin of a square, and a grey table.
  uchar grey(const Eigen::Vector3f& p_mm) const {
    const int i = static_cast<int>(std::floor(p_mm.x() / look_.square_mm)) + 1,
              j = static_cast<int>(std::floor(p_mm.y() / look_.square_mm)) + 1;
    if (i < -1 || j < -1 || i > look_.columns + 1 || j > look_.rows + 1) return 110;
    const bool square = i >= 0 && j >= 0 && i <= look_.columns && j <= look_.rows;
    return square && (i + j) % 2 == 0 ? 40 : 215;
  }

  const ScopeModel scope_;
  Look look_;
  std::vector<Eigen::Vector3f> rays_;
};

/// A scope of `width` by 3/4 of it, with test_lens()'s distortion made as large.
inline ScopeModel drawn_scope(const Lens& lens_640, int width_px) {
  const double scale = width_px / 640.0;
  ScopeModel scope{.name = "drawn", .width_px = width_px, .height_px = width_px * 3 / 4};
  scope.lens = lens_640;
  for (double* number : {&scope.lens.fx_px, &scope.lens.fy_px, &scope.lens.cx_px, &scope.lens.cy_px})
    *number *= scale;
  scope.mask = {.cx_px = scope.lens.cx_px, .cy_px = scope.lens.cy_px, .radius_px = 300 * scale};
  scope.cone_half_angle_rad = 0.6;
  return scope;
}

}  // namespace orcart::testing
