// Regions grow from their seeds, and a leak or a wrong seed is refused.
#include "tools/surface/region_growing.hpp"

#include <gtest/gtest.h>

#include "tests/tools/surface/sample_volume.hpp"

namespace orcart {
namespace {

RegionGrowing growing(const PlainPoint& seed = {20, 20, 20}) {
  return {.seeds_mm = {seed}, .lowest = 0, .highest = 48};
}

void expect_refused(const SampleVolume& sample, const RegionGrowing& options, const std::string& why) {
  const TemporaryFolder folder;
  const auto region = grow_region(read_sample(folder, sample), options, "head.mha");
  ASSERT_FALSE(region);
  EXPECT_NE(region.error().message.find(why), std::string::npos) << region.error().message;
  EXPECT_NE(region.error().message.find("head.mha"), std::string::npos);
}

/// A ball of 10 mm with a thin neck to a larger one; the neck is brighter than both.
SampleVolume two_balls(int neck) {
  SampleVolume volume = dark_ball(7);
  volume.size = {70, 40, 40};
  const auto ball = volume.intensity;
  volume.intensity = [ball, neck](int i, int j, int k) {
    const int x = i - 50, y = j - 20, z = k - 20;
    if (x * x + y * y + z * z <= 15 * 15) return 20;
    return j == 20 && k == 20 && i > 26 && i < 36 ? neck : ball(i, j, k);
  };
  return volume;
}

TEST(RegionGrowing, GrowsTheBallAroundTheSeed) {
  const TemporaryFolder folder;
  const auto region = grow_region(read_sample(folder, dark_ball(2)), growing(), "x");
  ASSERT_TRUE(region) << region.error().message;
  EXPECT_EQ(region->count.voxels, 33U);  // lattice points within 2 of the origin
  EXPECT_NEAR(region->volume_ml, 0.033, 1e-9);
  EXPECT_TRUE(region->notes.empty());
}

TEST(RegionGrowing, ObeysAnObliqueAffine) {
  const TemporaryFolder folder;
  SampleVolume volume = dark_ball(6);
  volume.direction = "0.8 0.6 0 -0.6 0.8 0 0 0 1";
  volume.offset = "100 0 -72";
  volume.spacing_mm = {1, 1, 2};
  // The ball's centre, voxel (20, 20, 20): offset + 20 (0.8, 0.6, 0) + 20 (-0.6, 0.8, 0) + 40 z.
  const auto region = grow_region(read_sample(folder, volume), growing({104, 28, -32}), "x");
  ASSERT_TRUE(region) << region.error().message;
  EXPECT_EQ(region->count.first, (std::array{14, 14, 14}));
  EXPECT_NEAR(region->volume_ml, 0.925 * 2, 1e-9);  // 925 lattice points within 6
}

TEST(RegionGrowing, NoticesWhereTheVolumeJumpsWithinTheRange) {
  expect_refused(two_balls(45), growing(), "jumps from 1.4 to 15.6 ml");
  const TemporaryFolder folder;
  const auto narrower = grow_region(read_sample(folder, two_balls(55)), growing(), "x");
  ASSERT_TRUE(narrower);
  EXPECT_EQ(narrower->curve.jump_at, 0);
}

TEST(RegionGrowing, AcceptsAJumpWhereToldAndTellsIt) {
  const TemporaryFolder folder;
  RegionGrowing options = growing();
  options.leak = LeakPolicy::accept;
  const auto region = grow_region(read_sample(folder, two_balls(45)), options, "x");
  ASSERT_TRUE(region);
  ASSERT_EQ(region->notes.size(), 1U);
  EXPECT_NE(region->notes[0].find("leaks"), std::string::npos);
}

TEST(RegionGrowing, TellsThatTheRegionReachesTheBorder) {
  const TemporaryFolder folder;
  SampleVolume volume = dark_ball(6);
  const auto ball = volume.intensity;
  volume.intensity = [ball](int i, int j, int k) { return i == 20 && j == 20 ? 30 : ball(i, j, k); };
  const auto region = grow_region(read_sample(folder, volume), growing(), "x");
  ASSERT_TRUE(region);
  ASSERT_EQ(region->notes.size(), 1U);
  EXPECT_NE(region->notes[0].find("reaches the border"), std::string::npos);
}

TEST(RegionGrowing, RefusesARegionThatIsTooLarge) {
  RegionGrowing options = growing();
  options.largest_ml = 10;
  expect_refused(dark_ball(15), options, "fills 14 ml, so it leaked; a narrower --range");
}

TEST(RegionGrowing, RefusesASeedOutsideTheRangeOrTheVolume) {
  expect_refused(dark_ball(6), growing({5, 5, 5}),
                 "the seed (5, 5, 5) mm (LPS) has the intensity 100; one from 0 to 48");
  expect_refused(dark_ball(6), growing({5, 5, 5}), "the volume holds 20 to 100");
  expect_refused(dark_ball(6), growing({-20, 20, 20}),
                 "the seed (-20, 20, 20) mm (LPS) lies outside the volume, which spans x 0..39");
}

TEST(LeakStep, IsTheWorstDoublingInTheOuterPartOfTheRange) {
  std::vector<double> curve(GrowthCurve::kSteps + 1, 8.0);
  EXPECT_EQ(leak_step(curve), 0);
  for (std::size_t i = 50; i < curve.size(); ++i) curve[i] = 40;
  EXPECT_EQ(leak_step(curve), 50);
}

TEST(LeakStep, IsNotWhereARegionComesTogetherOutOfTheNoise) {
  std::vector<double> curve(GrowthCurve::kSteps + 1, 900.0);
  for (std::size_t i = 0; i < 8; ++i) curve[i] = 2;
  EXPECT_EQ(leak_step(curve), 0);
}

}  // namespace
}  // namespace orcart
