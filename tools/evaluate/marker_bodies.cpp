// The tool definition's fixed array, as far as it is filled.
#include "tools/evaluate/marker_bodies.hpp"

#include "firmware-host/tracker/ndi/tool_definition.hpp"

namespace orcart {

Result<std::vector<Eigen::Vector3d>> markers_of_body(const std::filesystem::path& rom) {
  const auto tool = ndi::read_tool_definition(rom);
  if (!tool) return tl::unexpected(tool.error());
  std::vector<Eigen::Vector3d> markers;
  for (int i = 0; i < tool->marker_count; ++i) {
    const auto& marker = tool->markers_mm[static_cast<std::size_t>(i)];
    markers.emplace_back(marker[0], marker[1], marker[2]);
  }
  return markers;
}

}  // namespace orcart
