// Paired points: known transforms found again, errors by hand, and lists that fix no transform.
#include "realtime/registration/rigid_fit.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace orcart {
namespace {

using Points = std::vector<Eigen::Vector3d>;

const Points kCorner{{0, 0, 0}, {50, 0, 0}, {0, 30, 0}, {0, 0, 20}};
const Points kFlat{{0, 0, 0}, {50, 0, 0}, {0, 30, 0}, {40, 35, 0}};

Points moved(const Points& points, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_mm) {
  Points result;
  for (const auto& p : points) result.emplace_back(rotation * p + translation_mm);
  return result;
}

TEST(RigidFit, FindsAKnownTransformAgain) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const Points& from : {kCorner, kFlat}) {
    const Points to = moved(from, rotation, {100, -20, 7});
    const auto fit = rigid_fit({.from_mm = from, .to_mm = to});
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->rotation.isApprox(rotation, 1e-12));
    EXPECT_TRUE(fit->translation_mm.isApprox(Eigen::Vector3d(100, -20, 7), 1e-12));
    EXPECT_LT(fit->fre_mm, 1e-12);
  }
}

TEST(RigidFit, MeasuresWhatIsLeftOver) {
  // A square whose corners are moved out and in by turns, 1 mm along z: no rigid motion follows.
  const Points from{{10, 10, 0}, {-10, 10, 0}, {-10, -10, 0}, {10, -10, 0}};
  const Points to{{10, 10, 1}, {-10, 10, -1}, {-10, -10, 1}, {10, -10, -1}};
  const auto fit = rigid_fit({.from_mm = from, .to_mm = to});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->fre_mm, 1, 1e-12);
}

TEST(RigidFit, NeverAnswersAReflection) {
  Points mirrored = kCorner;
  for (auto& p : mirrored) p.z() = -p.z();
  const auto fit = rigid_fit({.from_mm = kCorner, .to_mm = mirrored});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rotation.determinant(), 1, 1e-12);
  EXPECT_GT(fit->fre_mm, 1);
}

TEST(RigidFit, RefusesPointsOnOneLine) {
  const Points line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-5, -10, -15}};
  EXPECT_FALSE(rigid_fit({.from_mm = line, .to_mm = kFlat}));
  EXPECT_FALSE(rigid_fit({.from_mm = kFlat, .to_mm = line}));
  const Points one_place(4, {3, 3, 3});
  EXPECT_FALSE(rigid_fit({.from_mm = one_place, .to_mm = kFlat}));
}

TEST(RigidFit, RefusesTooFewUnequalAndUnreadablePoints) {
  const Points two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(rigid_fit({.from_mm = two, .to_mm = two}).error().message,
            "there are 2 pairs of points; a rigid fit needs three or more");
  EXPECT_FALSE(rigid_fit({.from_mm = kCorner, .to_mm = two}));
  EXPECT_FALSE(rigid_fit({}));
  Points bad = kCorner;
  bad[2].y() = NAN;
  EXPECT_FALSE(rigid_fit({.from_mm = bad, .to_mm = kCorner}));
}

}  // namespace
}  // namespace orcart
