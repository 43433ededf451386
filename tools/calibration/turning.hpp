// How an angled scope turns against its camera head: the centre on the sensor, and the shaft's axis in the
// marker, from pictures of one board with the scope held still while the head is turned.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_command.hpp"

namespace orcart {

/// One picture.
struct TurnSight {
  std::string name;
  std::vector<BoardCorner> corners;
  std::optional<Pose<T, S>> X_TS;   ///< marker on the head, or with a second one: where it was
  std::optional<Pose<T, L>> X_TL;   ///< second marker, on whichever of shaft and head S is not on; needs X_TS
  std::optional<double> notch_rad;  ///< as found in the picture
};

struct TurningFit {
  Turning turning;
  std::vector<double> turns_rad;         ///< of each picture, since the passport was made; -pi..pi
  double rms_px = 0;                     ///< of the corners about where the turns place them
  std::vector<double> each_px;           ///< the same of each picture
  double range_rad = 0;                  ///< the largest turn between two pictures
  double axis_rms_mm = 0;                ///< head: of the marker about its circle
  double angle_rms_rad = 0;              ///< head: of the marker's turns about the pictures'
  double second_rms_rad = 0;             ///< second marker: of its turns about the pictures'
  double notch_rms_rad = 0;              ///< of the notch about the pictures' turns, where it is found
  std::optional<double> notch_zero_rad;  ///< where the notch is at turn 0
  std::vector<std::string> notes;
};

struct TurningTask {
  double aspect = 1;  ///< fy / fx
  double view_angle_rad = 0;
  TurnMarker marker = TurnMarker::shaft;
  Eigen::Vector3d view_S = Eigen::Vector3d::UnitZ();  ///< C's z axis at turn 0, in S: the axis's sign where
                                                      ///< the turns tell none (half turns only)
  std::optional<double> passport_notch_rad;           ///< else the first picture is at turn 0
};

/// Each corner goes round one centre: centre, turns and the corners' places at turn 0 by least squares. The
/// axis: what the marker's poses leave fixed.
///
/// Refuses fewer than three pictures, turns of less than 40 degrees in all, a centre that is known worse than
/// to a pixel, corners that do not go round one centre (scope or board moved), and a marker that does not
/// turn as the picture does. Where every sight has both markers, turning gets R_SL.
Result<TurningFit> fit_turning(const std::vector<TurnSight>& sights, const TurningTask& task);

struct TurningCommand {
  std::vector<std::filesystem::path> images;
  Pattern pattern;
  std::filesystem::path
      poses;  ///< of the scope's marker on the head, or with second_poses; empty: on the shaft
  std::filesystem::path second_poses;  ///< of a second marker; empty: there is none
  /// Where the scope's own marker sits; unset: on the head where there are `poses`, else on the shaft.
  std::optional<TurnMarker> marker;
  double view_angle_rad = 0;
};
struct TurningCalibration {
  ScopeModel scope;  ///< the passport given, with [turning]
  TurningFit fit;
  std::vector<TurnSight> sights;
  std::vector<std::string> notes;
};
Result<TurningCalibration> calibrate_turning(const TurningCommand& command, const ScopeModel& scope,
                                             const Progress& progress);

/// The turn that a picture's notch tells: -pi..pi. Refuses a passport without [turning] or notch and a
/// picture without one.
Result<double> turn_by_notch(const cv::Mat& picture, const ScopeModel& scope);

std::string turning_text(const TurningCalibration& calibration);
std::string turning_json(const TurningCalibration& calibration);
std::string turning_page(const TurningCalibration& calibration);

}  // namespace orcart
