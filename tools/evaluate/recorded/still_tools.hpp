// The paper's tracking error on recordings: how far the readings of a tool that stands still lie from their
// mean.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "realtime/base/result.hpp"
#include "tools/evaluate/statistics.hpp"

namespace orcart {

/// Where the tracker saw one tool, in its own frame, mm, in the order of time.
struct ToolTrack {
  std::string file, tool;
  std::vector<Eigen::Vector3d> places_mm;
};

/// A recording as the other verbs read it: a PLUS sequence (.mha, every XToTracker), an NDI dialogue (as
/// `orcart decode ndi`; a reading that came twice counts once), or poses (as --poses, one tool).
Result<std::vector<ToolTrack>> tool_tracks(const std::filesystem::path& file);

/// One stretch in which a tool stood still.
struct StillStretch {
  std::string file, tool;
  std::size_t readings = 0;
  double mean_mm = 0, rms_mm = 0, max_mm = 0;
};

struct StillTools {
  Statistics error;  ///< over all readings; the mean's confidence is from the means of ten readings each
  std::vector<StillStretch> stretches;
  std::size_t moving = 0;  ///< stretches of as many readings near each other that drift, as in a hand
};

/// A tool stands still where twenty readings or more lie within a millimetre of their mean and jump about it
/// rather than drift: successive_ratio() of 0.4 or more (hands make less than 0.3, trackers 0.6 to 2). What
/// never changes is no measurement and is left out.
StillTools still_tools(const std::vector<ToolTrack>& tracks);

}  // namespace orcart
