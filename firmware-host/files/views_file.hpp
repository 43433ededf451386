// views.csv: recorded pictures with the camera's pose on the mesh, for `orcart paint`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

struct View {
  std::filesystem::path image;  ///< absolute, or relative to the CSV's folder already applied
  Pose<M, C> X_MC;
};

struct ViewsFile {
  std::vector<View> views;
  std::vector<std::string> notes;  ///< e.g. poses that were re-orthonormalised, with their deviation
};

/// `image,m00,m01,...,m23`: row-major 3x4 X_MC, mm. Rotations are re-orthonormalised and told up to a
/// deviation |R'R - I| of 0.01, and refused beyond.
Result<ViewsFile> read_views(const std::filesystem::path& file);

}  // namespace orcart
