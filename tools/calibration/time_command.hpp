// What `orcart calibrate time` does: a recording in, the tracker's lag against the video out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/calibration/camera_command.hpp"
#include "tools/calibration/time_lag.hpp"

namespace orcart {

struct TimeCommand {
  std::filesystem::path recording;  ///< *.orcart, or a folder
  std::filesystem::path scope;      ///< for a folder
  std::optional<Pattern> pattern;   ///< nothing: features are followed
  double search_s = 0.25;
};

enum class MotionFrom { board, features };

struct TimeCalibration {
  LagFit fit;
  MotionFrom from = MotionFrom::features;
  double recorded_with_s = 0;          ///< [sync] of the recording
  double tracker_against_video_s = 0;  ///< what belongs into [sync] now: recorded_with_s + fit.lag_s
  std::size_t frames = 0, used = 0;    ///< in the recording; looked at, or with a board
  /// The scope's pace, for the page: by the tracker (mm/s at its own stamps shifted by the lag) and by the
  /// pictures (their own unit, made as large).
  std::vector<Eigen::Vector2d> tracker_pace, picture_pace;
  std::vector<std::string> notes;
};

/// Works on two pictures at a time.
Result<TimeCalibration> calibrate_time(const TimeCommand& command, const Progress& progress);

/// As text, as JSON, as the lines for cart.toml, and as one page.
std::string time_text(const TimeCalibration& calibration);
std::string time_json(const TimeCalibration& calibration);
std::string sync_snippet(const TimeCalibration& calibration);
std::string time_page(const TimeCalibration& calibration);

}  // namespace orcart
