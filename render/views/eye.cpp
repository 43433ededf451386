// Eyes and their matrices.
#include "render/views/eye.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

namespace orcart {
namespace {
glm::vec3 to_glm(const Eigen::Vector3d& v) {
  return {float(v.x()), float(v.y()), float(v.z())};
}

constexpr double kMargin = 1.08;           // clear space around the surface
constexpr double kNarrowestAspect = 1.15;  // narrower views see more above and below instead of less beside

}  // namespace

Eye eye_on(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& up) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(INFINITY), high = -low;
  for (const auto& v : mesh.vertices_mm) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  Eye eye;
  eye.target_mm = (0.5f * (low + high)).cast<double>();
  eye.up = up;
  const Eigen::Vector3d towards = from.normalized(), side = up.cross(towards).normalized(),
                        top = towards.cross(side);
  const double half_height = std::tan(eye.field_of_view_rad / 2) / kMargin,
               half_width = half_height * kNarrowestAspect;
  double distance_mm = 0;
  for (const auto& v : mesh.vertices_mm) {
    const Eigen::Vector3d p = v.cast<double>() - eye.target_mm;
    const double reach = std::max(std::abs(p.dot(top)) / half_height, std::abs(p.dot(side)) / half_width);
    distance_mm = std::max(distance_mm, p.dot(towards) + reach);
  }
  eye.position_mm = eye.target_mm + towards * distance_mm;
  return eye;
}

EyePair stereo_eyes(const Eye& middle, double base_of_distance) {
  const double aside_mm = (middle.target_mm - middle.position_mm).norm() * base_of_distance / 2;
  EyePair pair{middle, middle};
  pair.left.sideways_mm -= aside_mm;
  pair.right.sideways_mm += aside_mm;
  return pair;
}

EyeMatrices matrices_of(const Eye& eye, double aspect) {
  const double distance_mm = (eye.target_mm - eye.position_mm).norm();
  EyeMatrices matrices;
  matrices.view = glm::lookAt(to_glm(eye.position_mm), to_glm(eye.target_mm), to_glm(eye.up));
  const double half_height = std::tan(eye.field_of_view_rad / 2) * std::max(1.0, kNarrowestAspect / aspect);
  matrices.projection = glm::perspective(float(2 * std::atan(half_height)), float(aspect),
                                         float(distance_mm * 0.02), float(distance_mm * 3));
  matrices.projection[1][1] *= -1;  // row 0 is the top
  if (eye.sideways_mm != 0) {
    const auto aside = static_cast<float>(eye.sideways_mm);
    matrices.view[3][0] -= aside;
    matrices.projection[2][0] = -matrices.projection[0][0] * aside / static_cast<float>(distance_mm);
  }
  return matrices;
}

}  // namespace orcart
