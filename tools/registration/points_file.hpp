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
  bool numbered = false;  ///< the file has no name for it: `name` is its number from 1
};

/// Points in LPS, mm. Slicer's files are turned into LPS by what they state; where they state nothing they
/// are refused until `told` says it. points.csv (`name,x,y,z`) and plain rows are taken as they are, or
/// turned where `told` is RAS. Two points of one name, and rows that are short, are refused with their line.
/// What Slicer holds without a place (skipped, not yet placed) is left out and told in `notes`.
Result<std::vector<NamedPoint>> read_points(const std::filesystem::path& file,
                                            std::optional<Space> told = std::nullopt,
                                            std::vector<std::string>* notes = nullptr);

/// Points touched with a tracked pointer, mm in the reference body's own axes. Rows are taken as they are.
/// 3D Slicer names the axes of every scene R, A and S, a tracker's too, so it is the numbers that it shows
/// which are x, y and z; a file in LPS has the first two with the other sign.
Result<std::vector<NamedPoint>> read_measured_points(const std::filesystem::path& file,
                                                     std::vector<std::string>* notes = nullptr);

/// By the name's ending: .csv, .fcsv or .mrk.json; each states LPS where the format can.
Result<void> write_points(const std::filesystem::path& file, const std::vector<NamedPoint>& points);

}  // namespace orcart
