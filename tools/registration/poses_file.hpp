// Tracked poses from text: poses.csv, rows of 3x4 or 4x4 matrices, matrices over four lines, with or without
// names and times.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

/// X_TS of a marker S in the tracker T; R where the poses are already relative to the patient's reference.
struct NamedPose {
  std::string name;  ///< of the row, or its number from 1
  Pose<T, S> X_TS;
  bool numbered = false;  ///< `name` is its number
};

struct PosesFile {
  std::vector<NamedPose> poses;
  std::vector<std::string> notes;  ///< e.g. rotations that were mended
};

/// A file, or a folder of such files in the order of their names. A row has an optional name or time stamp
/// and 12 or 16 numbers, parted by commas or blanks; a matrix may also stand on four lines of four
/// numbers. Rotations are made exact and told up to a deviation of 0.01, refused beyond; translations that
/// can only be metres are refused; rows with NaN, which no tool was seen in, are left out and told.
Result<PosesFile> read_poses(const std::filesystem::path& file);

}  // namespace orcart
