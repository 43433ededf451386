// Registrations and pivot sweeps that others recorded, against what they and we found.
#include <gtest/gtest.h>

#include "realtime/registration/rigid_fit.hpp"
#include "tests/real_data/data_folder.hpp"
#include "tools/registration/pivot.hpp"
#include "tools/registration/register_points.hpp"
#include "tools/registration/sequence_file.hpp"

namespace orcart {
namespace {

using testing::data_folder;

TEST(RealPivot, FiftySevenPosesOfAPolarisGiveThePublishedOffset) {
  const auto folder = data_folder("pivot_ucl_polaris");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto poses = read_poses(*folder / "matrices");
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), 57U);
  const auto fit = fit_pivot(poses->poses);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->all.tip_mm - Eigen::Vector3d(-14.473, 394.634, -7.407)).norm(), 2e-3);
  EXPECT_LT((fit->all.pivot_mm - Eigen::Vector3d(-804.742, -85.474, -2112.131)).norm(), 2e-3);
  EXPECT_NEAR(fit->all.rms_component_mm, 1.760678, 1e-4);
  EXPECT_NEAR(fit->all.worst_mm, 12.262, 1e-3);
  EXPECT_LT(fit->robust.rms_mm, 0.6 * fit->all.rms_mm);
}

TEST(RealPivot, TheWholeRecordingGivesTheSame) {
  const auto folder = data_folder("pivot_ucl_polaris");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto poses = read_poses(*folder / "all_1151_time_ns_then_4x4_rowmajor.txt");
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), 1151U);
  const auto fit = fit_pivot(poses->poses);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->all.tip_mm - Eigen::Vector3d(-14.476172, 395.142822, -7.557904)).norm(), 1e-3);
  EXPECT_NEAR(fit->all.rms_mm, 3.184317, 1e-4);
}

TEST(RealRegistration, ANearlyFlatPelvisIsNotMirrored) {
  const auto folder = data_folder("reg_bard2019");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto ct = read_points(*folder / "ct_fiducials_mm.txt"),
             world = read_points(*folder / "world_fiducials_mm.txt");
  ASSERT_TRUE(ct && world);
  const auto r = register_points({.fixed = *world, .moving = *ct});
  ASSERT_TRUE(r) << r.error().message;
  Eigen::Matrix3d published;
  published << -0.04933494, -0.01438556, -0.99867869, 0.99212873, 0.11451658, -0.05066094, 0.11509405,
      -0.99331717, 0.00862266;
  EXPECT_LT((r->X_MR.rotation - published).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((r->X_MR.translation_mm - Eigen::Vector3d(-261.500627, -91.399369, -24.784062)).norm(), 1e-4);
  EXPECT_NEAR(r->fre_mm, 4.197100, 1e-5);
  EXPECT_NEAR(r->points[0].error_mm, 6.308, 1e-3);
}

TEST(RealRegistration, EightLandmarksAreFoundInARecordingOfAStylus) {
  const auto folder = data_folder("reg_plus_landmarks");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto sequence = read_sequence(*folder / "EightLandmarkPointsTrackedForPhantomRegistration.igs.mha");
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_EQ(sequence->frames.size(), 1000U);
  const auto rests = stylus_rests(*sequence, {108.565, 7.77385, 2.5389});
  ASSERT_TRUE(rests);
  EXPECT_EQ(rests->size(), 10U);
  const std::vector<Eigen::Vector3d> landmarks{{104.3, 5, 20}, {104.3, 45, 20}, {104.3, 45, 0},
                                               {104.3, -5, 0}, {-34.3, 45, 15}, {-34.3, -5, 20},
                                               {-34.3, -5, 0}, {-34.3, 45, 0}};
  RegistrationTask task{.moving = *rests, .pairing = Pairing::unknown};
  for (const auto& p : landmarks)
    task.fixed.push_back({.name = "#" + std::to_string(task.fixed.size() + 1), .mm = p});
  const auto r = register_points(task);
  ASSERT_TRUE(r) << r.error().message;
  EXPECT_EQ(r->points.size(), 8U);
  EXPECT_NEAR(r->fre_mm, 0.281, 0.03);
  // Phantom to Reference as published with the recording, error 0.198 mm.
  Eigen::Matrix3d turn;
  turn << -0.00479115, 0.00329566, -0.999983, -0.0127965, 0.999912, 0.00335674, 0.999907, 0.0128124,
      -0.00474856;
  const Pose<R, M> published{.rotation = turn, .translation_mm = {22.7064, -39.7536, 25.6504}};
  const Pose<R, M> ours = r->X_MR.inverse();
  double mean = 0;
  for (const auto& p : landmarks) mean += ((published * Point<M>{p}).mm - (ours * Point<M>{p}).mm).norm() / 8;
  EXPECT_LT(mean, 0.25);
}

TEST(RealRegistration, SequencesOfTwoToolsAndOfPicturesAreCounted) {
  const auto folder = data_folder("igs_plus_dev");
  if (!folder) GTEST_SKIP() << testing::kNoData;
  const auto probe = read_sequence(*folder / "SlidingProbeTrackingData.igs.mha");
  ASSERT_TRUE(probe) << probe.error().message;
  EXPECT_EQ(probe->frames.size(), 85U);
  EXPECT_EQ(probe->transforms_ok, 255U);
  const auto pictures = read_sequence(*folder / "NwirePhantomFreehandCropped.igs.mha");
  ASSERT_TRUE(pictures) << pictures.error().message;
  EXPECT_EQ(pictures->frames.size(), 20U);
}

}  // namespace
}  // namespace orcart
