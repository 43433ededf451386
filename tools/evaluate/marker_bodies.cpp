// The markers of a tool definition's file.
#include "tools/evaluate/marker_bodies.hpp"

#include "firmware-host/tracker/ndi/tool_definition.hpp"

namespace orcart {

Result<std::vector<Eigen::Vector3d>> markers_of_body(const std::filesystem::path& rom) {
  const auto tool = ndi::read_tool_definition(rom);
  if (!tool) return tl::unexpected(tool.error());
  return ndi::markers_of(*tool);
}

}  // namespace orcart
