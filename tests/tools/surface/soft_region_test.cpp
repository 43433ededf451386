// A region becomes a smooth field in its place, with gaps and cavities closed.
#include "tools/surface/soft_region.hpp"

#include <gtest/gtest.h>

#include "tests/tools/surface/sample_volume.hpp"

namespace orcart {
namespace {

Result<SoftenedRegion> softened(const SampleVolume& sample, const PlainPoint& seed,
                                const SoftRegion& options) {
  const TemporaryFolder folder;
  const Volume volume = read_sample(folder, sample);
  auto region = grow_region(volume, {.seeds_mm = {seed}, .lowest = 0, .highest = 48}, "x");
  if (!region) return tl::unexpected(region.error());
  return soften(*std::move(region), volume.lattice, options, "x");
}

PlainPoint middle_of(const SoftMask& mask, double& sum) {
  PlainPoint middle{};
  sum = 0;
  const auto nx = static_cast<std::size_t>(mask.lattice.size[0]),
             ny = static_cast<std::size_t>(mask.lattice.size[1]);
  for (std::size_t at = 0; at < mask.values.size(); ++at) {
    const PlainPoint place = place_of(
        mask.lattice,
        {static_cast<double>(at % nx), static_cast<double>(at / nx % ny), static_cast<double>(at / nx / ny)});
    for (std::size_t row = 0; row < 3; ++row)
      middle[row] += static_cast<double>(mask.values[at]) * place[row];
    sum += static_cast<double>(mask.values[at]);
  }
  for (double& x : middle) x /= sum;
  return middle;
}

TEST(SoftRegion, LiesWhereTheVolumesAffineSays) {
  SampleVolume volume = dark_ball(6);
  volume.direction = "-1 0 0 0 -1 0 0 0 1";  // as a RAS volume is stored
  volume.offset = "90 126 -72";
  volume.spacing_mm = {1, 1, 2};
  const auto soft = softened(volume, {70, 106, -32}, {});
  ASSERT_TRUE(soft) << soft.error().message;
  double sum = 0;
  const PlainPoint middle = middle_of(soft->mask, sum);
  EXPECT_NEAR(middle[0], 70, 0.05);
  EXPECT_NEAR(middle[1], 106, 0.05);
  EXPECT_NEAR(middle[2], -32, 0.05);
  EXPECT_NEAR(sum * 2, soft->volume_ml * 1000, 0.02 * soft->volume_ml * 1000);
}

TEST(SoftRegion, ClosesGapsAndCavities) {
  SampleVolume volume = dark_ball(8);
  const auto ball = volume.intensity;
  volume.intensity = [ball](int i, int j, int k) {
    const bool tunnel = i == 20 && j == 22;  // bright, one voxel wide, right through
    return tunnel || (i == 20 && j == 18 && k == 20) ? 100 : ball(i, j, k);
  };
  const auto left = softened(volume, {20, 20, 20}, {}),
             closed = softened(volume, {20, 20, 20}, {.close_mm = 1});
  ASSERT_TRUE(left && closed);
  EXPECT_EQ(left->filled_voxels, 1U);
  EXPECT_GE(closed->filled_voxels, 14U);
}

TEST(SoftRegion, ARegionAtTheBorderIsClosedThere) {
  SampleVolume volume = dark_ball(8);
  const auto ball = volume.intensity;
  volume.intensity = [ball](int i, int j, int k) { return ball(i, j, k + 20); };
  const auto soft = softened(volume, {20, 20, 0}, {});
  ASSERT_TRUE(soft) << soft.error().message;
  double sum = 0;
  EXPECT_GT(middle_of(soft->mask, sum)[2], 2);
  EXPECT_NEAR(sum, soft->volume_ml * 1000, 0.02 * sum);
}

TEST(SoftRegion, RefusesAGridThatIsTooFine) {
  const auto soft = softened(dark_ball(6), {20, 20, 20}, {.grid_mm = 0.01});
  ASSERT_FALSE(soft);
  EXPECT_NE(soft.error().message.find("a coarser --grid is expected"), std::string::npos);
}

TEST(Denoising, SpreadsABrightVoxelAndKeepsItsSum) {
  const TemporaryFolder folder;
  SampleVolume sample = dark_ball(0);
  sample.intensity = [](int i, int j, int k) { return i == 20 && j == 20 && k == 20 ? 250 : 0; };
  Volume volume = read_sample(folder, sample);
  ASSERT_TRUE(denoise(volume, 1.5, "x"));
  double sum = 0;
  for (const float value : volume.values) sum += static_cast<double>(value);
  EXPECT_NEAR(sum, 250, 2);
  EXPECT_LT(*std::max_element(volume.values.begin(), volume.values.end()), 10);
}

}  // namespace
}  // namespace orcart
