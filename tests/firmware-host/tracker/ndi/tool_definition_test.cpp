// Tool definitions: written and read back, and refused with a sentence that says why.
#include "firmware-host/tracker/ndi/tool_definition.hpp"

#include <gtest/gtest.h>

#include <array>

#include "firmware-host/tracker/ndi/tool_definition_writer.hpp"

namespace orcart::ndi {
namespace {

constexpr std::array<std::array<float, 3>, 3> kMarkers{{{0, 0, 0}, {50, 0, 0}, {0, 30, -20}}};

auto sample() {
  return encode_tool_definition({.markers_mm = kMarkers, .part_number = "PROBE-1", .main_type = 2});
}

std::string refusal(std::span<const std::byte> bytes) {
  const auto tool = parse_tool_definition(bytes, "x.rom");
  return tool ? "" : tool.error().message;
}

TEST(ToolDefinition, IsReadAsItWasWritten) {
  const auto tool = parse_tool_definition(sample(), "x.rom");
  ASSERT_TRUE(tool);
  EXPECT_EQ(tool->marker_count, 3);
  EXPECT_EQ(tool->markers_mm[2], kMarkers[2]);
  EXPECT_EQ(tool->part_number, "PROBE-1");
  EXPECT_EQ(tool->manufacturer, "orcart");
  EXPECT_EQ(tool->priority(), TrackingPriority::moving);
  EXPECT_EQ(tool->memory[kRomFileBytes], std::byte{0});
}

TEST(ToolDefinition, IsRefusedWithOneByteChanged) {
  auto bytes = sample();
  bytes[100] ^= std::byte{1};
  EXPECT_NE(refusal(bytes).find("is damaged: it states the checksum"), std::string::npos);
}

TEST(ToolDefinition, IsRefusedWhereItIsNoneAtAll) {
  EXPECT_EQ(refusal({}), "tool definition x.rom has 0 bytes; a tool definition has 752");
  auto bytes = sample();
  EXPECT_NE(refusal(std::span{bytes}.first(751)).find("751 bytes"), std::string::npos);
  bytes[0] = std::byte{'X'};
  EXPECT_NE(refusal(bytes).find("does not begin with NDI"), std::string::npos);
}

TEST(ToolDefinition, IsRefusedWithTooFewMarkers) {
  const auto bytes = encode_tool_definition({.markers_mm = std::span{kMarkers}.first(2)});
  EXPECT_NE(refusal(bytes).find("has 2 markers; 3 to 20"), std::string::npos);
}

TEST(ToolDefinition, ThatIsNotThereIsNamed) {
  const auto tool = read_tool_definition("/nowhere/tool.rom");
  ASSERT_FALSE(tool);
  EXPECT_NE(tool.error().message.find("/nowhere/tool.rom cannot be opened"), std::string::npos);
}

}  // namespace
}  // namespace orcart::ndi
