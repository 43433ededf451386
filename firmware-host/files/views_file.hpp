// views.csv: recorded pictures with the camera's pose on the mesh, for `orcart paint`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/twist.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

struct View {
  std::filesystem::path image;  ///< absolute, or relative to the CSV's folder already applied
  Pose<M, C> X_MC;
  double turn_rad = 0;  ///< of an angled scope's light post since the passport beside it; already in X_MC
  /// Of the camera by its marker's movement, mm/s and rad/s, in C, as a session keeps it; nothing: not known.
  std::optional<Twist> velocity;
};

struct ViewsFile {
  std::vector<View> views;
  std::vector<std::string> notes;  ///< e.g. poses that were re-orthonormalised, with their deviation
};

/// `image,m00,m01,...,m23[,turn_rad][,vx_mm_s,vy_mm_s,vz_mm_s,wx_rad_s,wy_rad_s,wz_rad_s]`: row-major 3x4
/// X_MC, mm; a velocity's six fields may be empty, all of them. Rotations are re-orthonormalised and told up
/// to a deviation |R'R - I| of 0.01, and refused beyond.
Result<ViewsFile> read_views(const std::filesystem::path& file);

/// Refuses views with a turn through a passport that has no [turning]; `file` is for the sentence.
Result<void> check_turns(const std::vector<View>& views, const ScopeModel& scope,
                         const std::filesystem::path& file);

}  // namespace orcart
