// What `orcart calibrate handeye` does: pictures of a board with the marker's poses in, the passport with
// X_SC out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_command.hpp"
#include "tools/calibration/hand_eye.hpp"

namespace orcart {

struct HandEyeCommand {
  std::vector<std::filesystem::path> images;
  std::filesystem::path poses;
  Pattern pattern;
  TrackerNoise noise;
};

struct HandEyeCalibration {
  ScopeModel scope;  ///< the passport given, with X_SC, the refined lens and residual_mm
  HandEyeFit closed_form, refined;
  std::optional<HandEyeSpread> spread;     ///< nothing where the views leave something open
  std::optional<double> leave_one_out_mm;  ///< nothing where three views leave none out
  std::vector<double> left_out_mm;         ///< of each view
  double least_left_out_mm = 0;            ///< no hand-eye pose could make the figure over all views smaller
  double floor_mm = 0;             ///< what the declared tracker noise alone makes of the board's scatter
  std::vector<std::string> names;  ///< of the views used
  std::vector<HandEyeView> views;  ///< those used, as they went into the fits
  RefineTask task;                 ///< how they were fitted
  std::vector<std::string> notes;
};

/// Poses belong to pictures by name (of the file, with or without its ending) where all names are there, by
/// order where none is. Refuses names of which only some are there. `file` is for the sentence.
Result<std::vector<Pose<T, S>>> poses_of_pictures(const std::vector<std::filesystem::path>& images,
                                                  const PosesFile& poses, const std::filesystem::path& file);

Result<HandEyeCalibration> calibrate_hand_eye(const HandEyeCommand& command, const ScopeModel& scope,
                                              const Progress& progress);

/// Board's origin through each view, pixels against radius, and each picture with where tracker and hand-eye
/// place its corners. `text` is the answer as the terminal shows it.
std::string hand_eye_page(const HandEyeCalibration& calibration, const std::string& text);

}  // namespace orcart
