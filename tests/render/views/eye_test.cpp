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

TEST(Eye, SeesTheWholeSurfaceFromAnySideInViewsOfAnyShape) {
  Surface surface = scenes::sphere({40, -10, 7}, 25, 16);
  for (Eigen::Vector3f& v : surface.mesh.vertices_mm) v.x() *= 3;
  for (const Eigen::Vector3d& from :
       {Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(1, 2, -0.5), Eigen::Vector3d(-9, 0, 0)}) {
    for (const double aspect : {0.6, 0.96, 1.2, 2.0}) {
      const EyeMatrices matrices = matrices_of(eye_on(surface.mesh, from, {0, 1, 0.01}), aspect);
      for (const Eigen::Vector3f& v : surface.mesh.vertices_mm) {
        const glm::vec3 at = seen_at(matrices, v);
        ASSERT_LE(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}), 1.0F);
      }
    }
  }
}

TEST(Eye, PutsUpAtTheTopRowAndRightAtTheRight) {
  const Surface surface = scenes::sphere({0, 0, 0}, 10, 8);
  const EyeMatrices matrices = matrices_of(eye_on(surface.mesh, {0, 0, 1}, {0, 1, 0}), 1);
  EXPECT_LT(seen_at(matrices, {0, 5, 0}).y, -0.1F) << "row 0 is the top";
  EXPECT_GT(seen_at(matrices, {5, 0, 0}).x, 0.1F);
}

// Base b = D/30 and a point z before the target: its parallax is b z / (D - z), in the target's plane.
TEST(StereoEyes, SeeTheTargetInOnePlaceAndWhatIsNearerWithItsParallax) {
  const Eye middle{.position_mm = {0, 0, 90}, .target_mm = {0, 0, 0}, .up = {0, 1, 0}};
  const EyePair eyes = stereo_eyes(middle);
  const EyeMatrices left = matrices_of(eyes.left, 1.25), right = matrices_of(eyes.right, 1.25);
  const double half_width_mm = 90 * std::tan(0.3) * 1.25;
  EXPECT_NEAR(seen_at(left, {0, 0, 0}).x, 0, 1e-6);
  EXPECT_NEAR(seen_at(right, {0, 0, 0}).x, 0, 1e-6);
  const glm::vec3 l = seen_at(left, {4, 3, 30}), r = seen_at(right, {4, 3, 30});
  EXPECT_NEAR((l.x - r.x) * half_width_mm, 3.0 * 30 / (90 - 30), 1e-4)
      << "nearer: the left eye sees it further right";
  EXPECT_NEAR(l.y, r.y, 1e-6);
}

}  // namespace
}  // namespace orcart
