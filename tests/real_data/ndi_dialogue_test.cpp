// Real dialogues with Polaris and Aurora devices, 2005: every CRC, transform and missing tool as counted
// elsewhere.
#include <gtest/gtest.h>

#include "firmware-host/tracker/ndi/dialogue_figures.hpp"
#include "tests/real_data/data_folder.hpp"

namespace orcart::testing {
namespace {

/// From the data's verified_reference.txt, made with another program.
struct Expected {
  const char* file;
  std::uint64_t commands, replies, crc_good, crc_bad, transforms, missing;
};
constexpr auto kExpected = std::to_array<Expected>({
    {"aurora_stream_11_05_2005.txt", 47, 49, 96, 0, 3, 17},
    {"polaris_stream_03_31_2005_1.txt", 1018, 1019, 2037, 0, 762, 238},
    {"polaris_stream_07_27_2005.bin", 25, 25, 50, 0, 8, 2},
    {"polaris_stream_07_27_2005.txt", 25, 25, 50, 0, 8, 2},
    {"polaris_stream_08_31_2005.bin", 207, 208, 415, 0, 111, 117},
    {"polaris_stream_08_31_2005_NDICommandInterpreter.records_0-110.txt", 110, 111, 291, 0, 43, 77},
    {"polaris_stream_11_05_2005.txt", 52, 53, 105, 0, 13, 14},
    {"polaris_stream_NDICommandInterpreterStress.bin", 209, 210, 416, 3, 105, 114},
    {"polaris_stream_NDICommandInterpreterStress.txt", 209, 210, 416, 3, 105, 114},
});

class NdiDialogues : public ::testing::TestWithParam<Expected> {};

TEST_P(NdiDialogues, HoldWhatWasCountedInThem) {
  const auto folder = data_folder("ndi_polaris_dev");
  if (!folder) GTEST_SKIP() << kNoData;
  const auto dialogue = ndi::read_dialogue(*folder / GetParam().file);
  ASSERT_TRUE(dialogue) << dialogue.error().message;
  const ndi::DialogueFigures figures = ndi::count_dialogue(*dialogue);
  EXPECT_EQ(figures.commands, GetParam().commands);
  EXPECT_EQ(figures.replies, GetParam().replies);
  EXPECT_EQ(figures.crc_good, GetParam().crc_good);
  EXPECT_EQ(figures.crc_bad, GetParam().crc_bad);
  EXPECT_EQ(figures.transforms, GetParam().transforms);
  EXPECT_EQ(figures.missing, GetParam().missing);
}

INSTANTIATE_TEST_SUITE_P(Recorded, NdiDialogues, ::testing::ValuesIn(kExpected));

}  // namespace
}  // namespace orcart::testing
