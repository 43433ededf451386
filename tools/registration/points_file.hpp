// Named points from points.csv, 3D Slicer's .fcsv and .mrk.json, or plain rows of three numbers; and back.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "firmware-host/files/space.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

struct NamedPoint {
  std::string name;
  Eigen::Vector3d mm = Eigen::Vector3d::Zero();
};

/// Points in LPS, mm. Slicer's files are turned into LPS by what they state; where they state nothing they
/// are refused until `told` says it. points.csv (`name,x,y,z`) and plain rows are taken as they are, or
/// turned where `told` is RAS. Two points of one name, and rows that are short, are refused with their line.
Result<std::vector<NamedPoint>> read_points(const std::filesystem::path& file,
                                            std::optional<Space> told = std::nullopt);

/// By the name's ending: .csv, .fcsv or .mrk.json; each states LPS where the format can.
Result<void> write_points(const std::filesystem::path& file, const std::vector<NamedPoint>& points);

}  // namespace orcart
