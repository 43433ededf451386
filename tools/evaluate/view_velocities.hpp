// How fast the scope moved at each view of views.csv, where the file tells it.
#pragma once

#include <string>

#include "firmware-host/files/views_file.hpp"
#include "tools/evaluate/error_chain.hpp"

namespace orcart {

/// The capture of a view, moving as its file tells, else as the model assumes.
Capture capture_of(const View& view, const ErrorModel& model);

/// How many views' velocities were told, and their mean speeds.
struct ViewVelocities {
  std::size_t told = 0, assumed = 0;
  double speed_mm_s = 0, turn_rad_s = 0;  ///< means over those that were told
};
ViewVelocities velocities_of(const std::vector<View>& views);

/// One line without its end.
std::string text_of(const ViewVelocities& velocities);
/// {"told": 3, "assumed": 0, "mean_mm_s": 5.1, "mean_rad_s": 0.12}
std::string json_of(const ViewVelocities& velocities);

}  // namespace orcart
