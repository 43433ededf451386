// Where the markers sit on a tracked body.
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"

namespace orcart {

/// Of an NDI tool definition (.rom): the markers' places on the body, mm.
Result<std::vector<Eigen::Vector3d>> markers_of_body(const std::filesystem::path& rom);

}  // namespace orcart
