// A calibrated scope for tests of the simulators: wide, a little distorted, small pictures.
#pragma once

#include "realtime/optics/scope_model.hpp"

namespace orcart::testing {

/// 160 x 120 pixels, a circle of radius 54 px that reaches about 33 degrees off axis.
inline ScopeModel pattern_scope() {
  ScopeModel scope;
  scope.width_px = 160;
  scope.height_px = 120;
  scope.lens = {.model = LensModel::brown,
                .fx_px = 90,
                .fy_px = 90,
                .cx_px = 80.5,
                .cy_px = 59.5,
                .coefficients = {-0.2, 0.05, 0, 0, 0}};
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, 1.2);
  scope.mask = {.cx_px = 80, .cy_px = 60, .radius_px = 54};
  scope.cone_half_angle_rad = 0.6;
  scope.X_SC = {.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                .translation_mm = {5, -20, 180}};
  return scope;
}

}  // namespace orcart::testing
