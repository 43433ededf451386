// Pivot calibration: a known tip found again through noise and outliers, and sweeps that leave it open
// refused.
#include "tools/registration/pivot.hpp"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace orcart {
namespace {

const Eigen::Vector3d kTip(10, 180, -5), kPivot(-100, 50, -1500);

struct Sweep {
  int poses = 200;
  double tilt_rad = 0.5;
  double noise_mm = 0;
  int outliers = 0;
  bool one_axis = false;
};

std::vector<NamedPose> swept(const Sweep& sweep) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<NamedPose> poses;
  for (int i = 0; i < sweep.poses; ++i) {
    const Eigen::Vector3d axis =
        sweep.one_axis ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(any(random), any(random), any(random));
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(sweep.tilt_rad * any(random), axis.normalized()).toRotationMatrix();
    NamedPose pose{.name = std::to_string(i),
                   .X_TS = {.rotation = turn, .translation_mm = kPivot - turn * kTip}};
    pose.X_TS.translation_mm += sweep.noise_mm * Eigen::Vector3d(noise(random), noise(random), noise(random));
    if (i < sweep.outliers) pose.X_TS.translation_mm += Eigen::Vector3d(8, -3, 5);
    poses.push_back(pose);
  }
  return poses;
}

TEST(Pivot, FindsAKnownTipExactly) {
  const auto fit = fit_pivot(swept({}));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->all.tip_mm - kTip).norm(), 1e-8);
  EXPECT_LT((fit->robust.pivot_mm - kPivot).norm(), 1e-8);
  EXPECT_LT(fit->all.rms_mm, 1e-8);
}

TEST(Pivot, FindsItThroughNoiseWithinItsOwnDeviation) {
  const auto fit = fit_pivot(swept({.noise_mm = 0.2}));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->robust.tip_mm - kTip).norm(), 4 * fit->robust.deviation_mm.norm());
  EXPECT_LT((fit->robust.tip_mm - kTip).norm(), 0.3);
}

TEST(Pivot, LeavesOutliersOut) {
  const auto fit = fit_pivot(swept({.noise_mm = 0.1, .outliers = 50}));
  ASSERT_TRUE(fit);
  EXPECT_GT((fit->all.tip_mm - kTip).norm(), 0.5);
  EXPECT_LT((fit->robust.tip_mm - kTip).norm(), 0.2);
  EXPECT_LE(fit->robust.poses, 150U);
  EXPECT_GE(fit->robust.poses, 140U);
}

TEST(Pivot, RefusesDegenerateSweepsAndSaysWhy) {
  EXPECT_NE(fit_pivot(swept({.poses = 4})).error().message.find("4 poses"), std::string::npos);
  EXPECT_NE(fit_pivot(swept({.tilt_rad = 0.05})).error().message.find("leaves its tip open"),
            std::string::npos);
  EXPECT_NE(fit_pivot(swept({.one_axis = true})).error().message.find("one axis only"), std::string::npos);
}

}  // namespace
}  // namespace orcart
