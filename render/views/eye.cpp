// Eyes and their matrices.
#include "render/views/eye.hpp"

#include <algorithm>
#include <cmath>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

namespace orcart {
namespace {
glm::vec3 to_glm(const Eigen::Vector3d& v) {
  return {float(v.x()), float(v.y()), float(v.z())};
}
}  // namespace

Eye eye_on(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& up) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(INFINITY), high = -low;
  for (const auto& v : mesh.vertices_mm) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  Eye eye;
  eye.target_mm = (0.5f * (low + high)).cast<double>();
  double radius_mm = 0;
  for (const auto& v : mesh.vertices_mm)
    radius_mm = std::max(radius_mm, (v.cast<double>() - eye.target_mm).norm());
  eye.up = up;
  eye.position_mm = eye.target_mm + from.normalized() * radius_mm / std::sin(eye.field_of_view_rad / 2);
  return eye;
}

EyeMatrices matrices_of(const Eye& eye, double aspect) {
  const double distance_mm = (eye.target_mm - eye.position_mm).norm();
  EyeMatrices matrices;
  matrices.view = glm::lookAt(to_glm(eye.position_mm), to_glm(eye.target_mm), to_glm(eye.up));
  matrices.projection = glm::perspective(float(eye.field_of_view_rad), float(aspect),
                                         float(distance_mm * 0.02), float(distance_mm * 3));
  matrices.projection[1][1] *= -1;  // row 0 is the top
  return matrices;
}

}  // namespace orcart
