// Volumes that others recorded.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/real_data/data_folder.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {
namespace {

using orcart::testing::data_folder;
using orcart::testing::kNoData;

TEST(RecordedVolumes, TheLegoPhantomIsTwoStacksWithAGap) {
  const auto data = data_folder("vol_dicom_lego10");
  if (!data) GTEST_SKIP() << kNoData;
  const auto refused = read_volume({.path = *data});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("2 stacks"), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("--stack N"), std::string::npos);
  for (const int wanted : {1, 2}) {
    const auto stack = read_volume({.path = *data, .stack = wanted});
    ASSERT_TRUE(stack) << stack.error().message;
    EXPECT_EQ(stack->lattice.size, (std::array{512, 512, 5}));
    EXPECT_NEAR(step_length_mm(stack->lattice, 0), 0.390625, 1e-9);
    EXPECT_NEAR(step_length_mm(stack->lattice, 2), 1.875, 1e-6);
    EXPECT_FALSE(stack->frame_of_reference.empty());
    EXPECT_GE(*std::min_element(stack->values.begin(), stack->values.end()), -3024);
  }
}

TEST(RecordedVolumes, ColinsAffineIsItsHeaders) {
  const auto data = data_folder("vol_mr_colin27");
  if (!data) GTEST_SKIP() << kNoData;
  const auto volume = read_volume({.path = *data / "ch2bet.nii.gz"});
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.size, (std::array{181, 217, 181}));
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{90, 125, -71}));
  EXPECT_EQ(std::count_if(volume->values.begin(), volume->values.end(), [](float v) { return v > 50; }),
            1667541);
}

TEST(RecordedVolumes, TheCtHeadHasItsPublishedRangeAndMean) {
  const auto data = data_folder("vol_ct_headsq");
  if (!data) GTEST_SKIP() << kNoData;
  EXPECT_FALSE(read_volume({.path = *data / "quarter.nhdr"}));
  const auto volume = read_volume({.path = *data / "quarter.nhdr", .where_unstated = Space::lps});
  ASSERT_TRUE(volume) << volume.error().message;
  double sum = 0;
  for (const float v : volume->values) sum += static_cast<double>(v);
  EXPECT_EQ(*std::max_element(volume->values.begin(), volume->values.end()), 3926);
  EXPECT_NEAR(sum / static_cast<double>(volume->values.size()), 507.6873, 1e-3);
  const auto meta = read_volume({.path = *data / "HeadMRVolume.mhd", .where_unstated = Space::lps});
  ASSERT_TRUE(meta) << meta.error().message;
  EXPECT_EQ(meta->lattice.size, (std::array{48, 62, 42}));
}

}  // namespace
}  // namespace orcart
