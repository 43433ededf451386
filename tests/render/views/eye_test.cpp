// An eye that is put before a surface sees all of it.
#include "render/views/eye.hpp"

#include <gtest/gtest.h>

#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

glm::vec3 seen_at(const EyeMatrices& matrices, const Eigen::Vector3f& p) {
  const glm::vec4 clip = matrices.projection * (matrices.view * glm::vec4(p.x(), p.y(), p.z(), 1));
  return glm::vec3(clip) / clip.w;
}

TEST(Eye, SeesTheWholeSurfaceFromAnySide) {
  const Surface surface = scenes::sphere({40, -10, 7}, 25, 16);
  for (const Eigen::Vector3d& from :
       {Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(1, 2, -0.5), Eigen::Vector3d(-9, 0, 0)}) {
    const EyeMatrices matrices = matrices_of(eye_on(surface.mesh, from, {0, 1, 0.01}), 1.2);
    for (const Eigen::Vector3f& v : surface.mesh.vertices_mm) {
      const glm::vec3 at = seen_at(matrices, v);
      ASSERT_LE(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}), 1.0F);
    }
  }
}

TEST(Eye, PutsUpAtTheTopRowAndRightAtTheRight) {
  const Surface surface = scenes::sphere({0, 0, 0}, 10, 8);
  const EyeMatrices matrices = matrices_of(eye_on(surface.mesh, {0, 0, 1}, {0, 1, 0}), 1);
  EXPECT_LT(seen_at(matrices, {0, 5, 0}).y, -0.1F) << "row 0 is the top";
  EXPECT_GT(seen_at(matrices, {5, 0, 0}).x, 0.1F);
}

}  // namespace
}  // namespace orcart
