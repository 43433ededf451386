// Pictures as a pinhole camera would have seen them: the same focal length, distortion taken out.
#pragma once

#include <filesystem>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// Writes NAME.png into `folder` for every image. Before it writes any it refuses pictures that are not
/// the scope's size, and names by which one would take another's place, or that of a picture read.
Result<void> rectify(const std::vector<std::filesystem::path>& images, const ScopeModel& scope,
                     const std::filesystem::path& folder);

}  // namespace orcart
