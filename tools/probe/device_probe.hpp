// What the device nodes tell: cameras with their modes and controls, GPIO chips and keyboards, encoders,
// cards and connectors.
#pragma once

#include <optional>
#include <string>

#include "board/linux/device_calls.hpp"
#include "tools/probe/findings.hpp"

namespace orcart {

/// Each opens and asks, and changes nothing; a connector is probed, which may take half a second.
std::vector<Finding> probe_cameras();
/// One node; nothing for one that is no camera, such as a camera's second node, for metadata.
std::optional<Finding> probe_camera(DeviceCalls& calls, const std::string& path);
std::vector<Finding> probe_pedals();
/// Turn encoders; nothing where there is none, for few carts want one.
std::vector<Finding> probe_encoders();
std::vector<Finding> probe_panels();

}  // namespace orcart
