// How far before the optical centre its axis leaves the distal window, from distances to a board that are
// known: the paper's tip localisation, and its error.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_command.hpp"

namespace orcart {

/// One view of the board's plane.
struct TipView {
  std::string name;
  double known_mm = 0;  ///< from the window to the board, along the optical axis, as measured by hand
  double camera_mm =
      0;  ///< from the optical centre to the board, along the optical axis, as the camera sees it
};

struct TipFit {
  double window_mm = 0;     ///< of E before C on the optical axis: X_CE's z
  double deviation_mm = 0;  ///< standard deviation of it, by the views' scatter about it
  double scale = 1;         ///< by which the camera's distances grow faster than the known ones
  double scale_deviation = 0;
  std::vector<double> errors_mm;  ///< of each view's distance with the window placed by all other views
  double mean_mm = 0, sd_mm = 0, worst_mm = 0;  ///< of the errors' sizes
  std::vector<std::string> notes;
};

/// Where the optical axis meets the board's plane, mm from C. Refuses a board seen edge on.
Result<double> axis_distance_mm(const Pose<C, B>& X_CB);

/// Refuses fewer than three views, one distance only, metres, and distances that grow otherwise than the
/// camera's (a board of another square size).
Result<TipFit> fit_tip(const std::vector<TipView>& views);

struct TipCommand {
  std::vector<std::filesystem::path> images;
  std::vector<double> distances_mm;  ///< one a picture
  Pattern pattern;
};
struct TipCalibration {
  /// The passport given, with X_CE and its covariance: E is on C's z axis by its definition, so all that is
  /// not known of it is along that axis.
  ScopeModel scope;
  std::vector<TipView> views;
  TipFit fit;
  double lens_mm =
      0;  ///< standard deviation of the window's place by what the lens's calibration leaves open
  double deviation_mm = 0;  ///< of the window's place, all in all: as the passport has it
  /// In the window, between C's z axis and the ray through the middle of the picture's circle: the lenses
  /// stand about that ray, so the glass's own middle may be as far from E. Nothing where the passport has no
  /// circle.
  std::optional<double> middle_mm;
};

/// The same from boards already found. One distance a view; a view without corners is noted and not used.
Result<TipCalibration> calibrate_tip(const std::vector<BoardView>& views,
                                     const std::vector<double>& distances_mm, const ScopeModel& scope);
Result<TipCalibration> calibrate_tip(const TipCommand& command, const ScopeModel& scope,
                                     const Progress& progress);

/// Distances known and seen, and each error with its view left out. `text` is the answer as the terminal
/// shows it.
std::string tip_page(const TipCalibration& calibration, const std::string& text);

}  // namespace orcart
