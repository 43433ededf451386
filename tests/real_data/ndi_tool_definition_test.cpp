// Real tool definitions: read, uploaded to the emulated tracker, tracked.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/firmware-host/tracker/tracker_rig.hpp"
#include "tests/real_data/data_folder.hpp"

namespace orcart::testing {
namespace {

std::vector<std::filesystem::path> definitions() {
  std::vector<std::filesystem::path> files;
  for (const char* set : {"ndi_roms_plus_dev", "ndi_polaris_dev"}) {
    const auto folder = data_folder(set);
    if (!folder) continue;
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
      if (entry.path().extension() == ".rom") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(RealToolDefinitions, AreAllReadUploadedAndTracked) {
  const auto files = definitions();
  if (files.empty()) GTEST_SKIP() << kNoData;
  EXPECT_EQ(files.size(), 17u);
  for (const auto& file : files) {
    const auto tool = ndi::read_tool_definition(file);
    ASSERT_TRUE(tool) << tool.error().message;
    TrackerRig rig(NdiSettings{.tools = {*tool}}, {.noise = {.sigma_mm = 0.1}});
    rig.start();
    rig.run_for(100ms);
    EXPECT_EQ(rig.driver.reply().tools[0].state, ToolState::seen) << file;
  }
}

TEST(RealToolDefinitions, HaveTheMarkersThatWereDecodedElsewhere) {
  const auto folder = data_folder("ndi_roms_plus_dev");
  if (!folder) GTEST_SKIP() << kNoData;
  const auto tool = ndi::read_tool_definition(*folder / "8700340.rom");
  ASSERT_TRUE(tool);
  EXPECT_EQ(tool->marker_count, 4);
  EXPECT_EQ(tool->markers_mm[3], (std::array<float, 3>{0, -25, 135}));
  EXPECT_EQ(tool->part_number, "8700340");
  EXPECT_EQ(tool->manufacturer, "NDI");
}

}  // namespace
}  // namespace orcart::testing
