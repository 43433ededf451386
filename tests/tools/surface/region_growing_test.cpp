// Regions grow from their seeds, in the patient's space, and a leak or a wrong seed is refused.
#include "tools/surface/region_growing.hpp"

#include <gtest/gtest.h>

#include "tests/tools/surface/sample_volume.hpp"

namespace orcart {
namespace {

RegionGrowing growing(const std::filesystem::path& volume, const PlainPoint& seed = {20, 20, 20}) {
  return {.volume = volume, .seeds_mm = {seed}, .lowest = 0, .highest = 48};
}

void expect_refused(const RegionGrowing& options, const std::string& why) {
  const auto region = grow_region(options);
  ASSERT_FALSE(region);
  EXPECT_NE(region.error().message.find(why), std::string::npos) << region.error().message;
  EXPECT_NE(region.error().message.find(options.volume.string()), std::string::npos);
}

TEST(RegionGrowing, GrowsTheBallAroundTheSeed) {
  const TemporaryFolder folder;
  const auto region = grow_region(growing(dark_ball(2).write(folder)));
  ASSERT_TRUE(region) << region.error().message;
  EXPECT_EQ(region->voxels, 33U);  // lattice points within 2 of the origin
  EXPECT_NEAR(region->volume_ml, 0.033, 1e-9);
}

TEST(RegionGrowing, PlacesTheRegionByTheVolumesAffine) {
  const TemporaryFolder folder;
  SampleVolume volume = dark_ball(6);
  volume.direction = "-1 0 0 0 -1 0 0 0 1";  // as a RAS volume is stored
  volume.offset = "90 126 -72";
  volume.spacing_mm = {1, 1, 2};
  const auto region = grow_region(growing(volume.write(folder), {70, 106, -32}));
  ASSERT_TRUE(region) << region.error().message;
  PlainPoint middle{};
  double sum = 0;
  const SoftMask& mask = region->mask;
  for (std::size_t at = 0; at < mask.values.size(); ++at) {
    const auto nx = static_cast<std::size_t>(mask.size[0]), ny = static_cast<std::size_t>(mask.size[1]);
    const std::array<double, 3> ijk{static_cast<double>(at % nx), static_cast<double>(at / nx % ny),
                                    static_cast<double>(at / nx / ny)};
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle[row] += mask.values[at] * (mask.origin_mm[row] / 3 + ijk[axis] * mask.step_mm[axis][row]);
    sum += mask.values[at];
  }
  EXPECT_NEAR(middle[0] / sum, 70, 0.05);
  EXPECT_NEAR(middle[1] / sum, 106, 0.05);
  EXPECT_NEAR(middle[2] / sum, -32, 0.05);
  EXPECT_NEAR(sum * 2, region->volume_ml * 1000, 0.02 * region->volume_ml * 1000);
}

TEST(RegionGrowing, ClosesGapsAndCavities) {
  const TemporaryFolder folder;
  SampleVolume volume = dark_ball(8);
  const auto ball = volume.intensity;
  volume.intensity = [ball](int i, int j, int k) {
    const bool tunnel = i == 20 && j == 22;  // bright, one voxel wide, right through
    return tunnel || (i == 20 && j == 18 && k == 20) ? 100 : ball(i, j, k);
  };
  RegionGrowing options = growing(volume.write(folder));
  const auto left = grow_region(options);
  options.close_mm = 1;
  const auto closed = grow_region(options);
  ASSERT_TRUE(left && closed);
  EXPECT_EQ(left->filled_voxels, 1U);
  EXPECT_GE(closed->filled_voxels, 14U);
}

TEST(RegionGrowing, RefusesALeakToTheBorder) {
  const TemporaryFolder folder;
  SampleVolume volume = dark_ball(6);
  const auto ball = volume.intensity;
  volume.intensity = [ball](int i, int j, int k) { return i == 20 && j == 20 ? 30 : ball(i, j, k); };
  expect_refused(growing(volume.write(folder)), "reaches the border of the volume");
}

TEST(RegionGrowing, RefusesARegionThatIsTooLarge) {
  const TemporaryFolder folder;
  RegionGrowing options = growing(dark_ball(15).write(folder));
  options.largest_ml = 10;
  expect_refused(options, "fills 14 ml, so it leaked; a narrower --range");
}

TEST(RegionGrowing, RefusesASeedOutsideTheRangeOrTheVolume) {
  const TemporaryFolder folder;
  const auto file = dark_ball(6).write(folder);
  expect_refused(growing(file, {5, 5, 5}),
                 "the seed (5, 5, 5) mm (LPS) has the intensity 100; one from 0 to 48");
  expect_refused(growing(file, {-20, 20, 20}), "the seed (-20, 20, 20) mm (LPS) lies outside the volume");
}

TEST(RegionGrowing, RefusesAGridThatIsTooFine) {
  const TemporaryFolder folder;
  RegionGrowing options = growing(dark_ball(6).write(folder));
  options.grid_mm = 0.01;
  expect_refused(options, "a coarser --grid is expected");
}

TEST(RegionGrowing, RefusesWhatIsNoVolume) {
  const TemporaryFolder folder;
  expect_refused(growing(folder / "missing.nii.gz"), "is not there");
  expect_refused(growing(folder.write("text.nii", "hello")),
                 "NIfTI (.nii, .nii.gz), .nrrd and MetaImage (.mha)");
  expect_refused(growing(folder.write("empty.nrrd", "")), ".nrrd and MetaImage (.mha) are accepted");
}

TEST(RegionGrowing, RefusesAVolumeThatIsCutShort) {
  const TemporaryFolder folder;
  const auto file = dark_ball(6).write(folder);
  std::filesystem::resize_file(file, 30000);
  expect_refused(growing(file), "fewer than the 64000 bytes its header says; it is cut short");
}

TEST(RegionGrowing, RefusesANrrdThatIsCutShort) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "volume.nrrd", "NRRD0004\ntype: unsigned char\ndimension: 3\nsizes: 9 9 9\nencoding: raw\n\n012345");
  expect_refused(growing(file), "cannot be read as a volume");
}

TEST(RegionGrowing, RefusesAVolumeThatIsABomb) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("volume.mha",
                   "ObjectType = Image\nNDims = 3\nDimSize = 2000 2000 2000\nElementType = MET_UCHAR\n"
                   "ElementDataFile = LOCAL\n");
  expect_refused(growing(file), "8000000000 voxels; up to 1000000000 are accepted");
}

TEST(RegionGrowing, RefusesAFourthDimension) {
  const TemporaryFolder folder;
  const auto file = folder.write("volume.mha",
                                 "ObjectType = Image\nNDims = 4\nDimSize = 2 2 2 2\nElementType = MET_UCHAR\n"
                                 "ElementDataFile = LOCAL\n0123456789abcdef");
  expect_refused(growing(file), "has 4 dimensions; 3 are accepted");
}

}  // namespace
}  // namespace orcart
