// A hollow ball seen from inside, with a scope and marker bodies, for the tests of the evaluation.
#pragma once

#include <cmath>
#include <numbers>

#include "tools/evaluate/scene.hpp"

namespace orcart {

/// A geodesic-like ball of `radius_mm`, counter-clockwise from outside.
inline TriangleMesh hollow_ball(float radius_mm, std::uint32_t rings = 48) {
  TriangleMesh mesh;
  const std::uint32_t around = 2 * rings;
  for (std::uint32_t r = 1; r < rings; ++r)
    for (std::uint32_t a = 0; a < around; ++a) {
      const double polar = std::numbers::pi * r / rings, azimuth = 2 * std::numbers::pi * a / around;
      mesh.vertices_mm.push_back(radius_mm * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                             std::sin(polar) * std::sin(azimuth),
                                                             std::cos(polar))
                                                 .cast<float>());
    }
  const auto top = static_cast<std::uint32_t>(mesh.vertices_mm.size()), bottom = top + 1;
  mesh.vertices_mm.emplace_back(0, 0, radius_mm);
  mesh.vertices_mm.emplace_back(0, 0, -radius_mm);
  for (std::uint32_t a = 0; a < around; ++a) {
    const std::uint32_t b = (a + 1) % around, last = (rings - 2) * around;
    mesh.triangles.push_back({top, a, b});
    mesh.triangles.push_back({bottom, last + b, last + a});
    for (std::uint32_t r = 0; r + 2 < rings; ++r) {
      mesh.triangles.push_back({r * around + a, (r + 1) * around + a, r * around + b});
      mesh.triangles.push_back({r * around + b, (r + 1) * around + a, (r + 1) * around + b});
    }
  }
  return mesh;
}

inline ScopeModel plain_scope() {
  ScopeModel scope{.name = "pinhole", .width_px = 640, .height_px = 480};
  scope.lens = {.fx_px = 340, .fy_px = 340, .cx_px = 320, .cy_px = 240, .max_angle_rad = 1.2};
  scope.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 200};
  scope.cone_half_angle_rad = 0.6;
  scope.X_SC.translation_mm = {0, 0, 250};
  scope.X_CE.translation_mm = {0, 0, 1};
  return scope;
}

/// Owns what an EvaluationScene borrows.
struct BallScene {
  TriangleMesh mesh = hollow_ball(30);
  RayScene rays = *RayScene::create(mesh);
  ScopeModel scope = plain_scope();

  EvaluationScene scene() const {
    Pose<M, R> X_MR;
    X_MR.translation_mm = {0, -120, 60};
    return {.mesh = mesh,
            .rays = rays,
            .scope = scope,
            .X_MR = X_MR,
            .scope_markers_mm = {{0, 0, 0}, {0, 52, 18}, {46, -31, 9}, {-38, -44, 0}},
            .reference_markers_mm = {{0, 0, 0}, {0, 62, 0}, {51, -24, 0}, {-33, -47, 0}}};
  }
};

}  // namespace orcart
