// A recording for `orcart calibrate time`: the marker's poses and the camera's pictures, both with stamps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/pose_track.hpp"

namespace orcart {

struct TimeRecording {
  std::vector<TrackedPose> track;   ///< rising in time
  std::vector<double> frames_at_s;  ///< mid-exposures, rising, on the same clock
  /// The picture (8 bit, BGR) of a frame; refuses one that is not of the scope's size. Any thread.
  std::function<Result<cv::Mat>(std::size_t frame)> picture;
  ScopeModel scope;
  double recorded_with_s = 0;  ///< what [sync] tracker_against_video already had shifted the poses by
  std::vector<std::string> notes;
};

/// A session of the cart (*.orcart): its streams, made by holding the pedal while the scope moves. Each
/// frame's pose was looked up by the cart, so poses and frames have the same stamps. The passport is the
/// session's own.
///
/// Or a folder: frames.csv (image,time_ms: mid-exposure), poses.csv (time_ms,m00,...,m23: the scope marker in
/// the tracker or in a reference that stands still, mm), the pictures, and `scope_file`.
///
/// Refuses a session without streams, stamps that do not rise, and a first picture that is not of the
/// scope's size.
Result<TimeRecording> read_time_recording(const std::filesystem::path& recording,
                                          const std::filesystem::path& scope_file);

}  // namespace orcart
