// The paper's Table 1 on recorded data: tracked pictures of a board, each judged, and painted onto the
// board's plane, by what the others say.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/calibration/hand_eye_command.hpp"
#include "tools/evaluate/recorded/board_tip.hpp"
#include "tools/evaluate/recorded/flat_painting.hpp"
#include "tools/evaluate/recorded/light_steps.hpp"
#include "tools/evaluate/recorded/tracking_error.hpp"
#include "tools/evaluate/statistics.hpp"
#include "tools/mesh/surface_report.hpp"

namespace orcart {

/// A corner of the board in a painting.
struct PaintedCorner {
  Eigen::Vector2d grid_mm = Eigen::Vector2d::Zero();   ///< where it is printed
  Eigen::Vector2d found_mm = Eigen::Vector2d::Zero();  ///< where it is found in the painting
  Eigen::Vector2d ray_mm = Eigen::Vector2d::Zero();    ///< where the ray of its pixel meets the plane
};

/// One view that took no part in what it was painted by.
struct ViewMapping {
  std::string image;
  std::size_t seen = 0;  ///< corners found in the picture
  std::vector<PaintedCorner> corners;
  Statistics error;        ///< from found_mm to grid_mm
  Statistics painting;     ///< from found_mm to ray_mm: what painting adds
  double lens_rms_mm = 0;  ///< of the corners through the view's own best pose: no tracker, no hand-eye in it
  double origin_mm = 0;    ///< 3-D, of the board's origin: what `orcart calibrate handeye` tells
  TipErrors tip;
  FlatPainting flat;  ///< only this view
};

/// The corners of `view` that are found again in its painting: by the names that dots or markers give them
/// there, else each as the one that lies within 0.3 of a square of where its pixel's ray meets the plane. The
/// error's statistics are one group.
ViewMapping corners_in_painting(const BoardView& view, const Pattern& pattern, const Lens& lens,
                                const Pose<M, C>& X_MC, FlatPainting flat);

/// What is painted, with a view's pose from all others.
struct LeftOut {
  ScopeModel scope;  ///< lens and X_SC of the others
  PosedPicture posed;
  BoardView view;
  Pose<C, B> X_CB;             ///< its own best pose, through the others' lens: no tracker, no hand-eye in it
  double corner_sigma_px = 0;  ///< of a corner, as the others' fit weighed it
  double origin_mm = 0;
};

/// For each view: hand-eye and the place of the board (and the lens, where that was moved) from the others
/// alone. `lens` is the passport's.
Result<std::vector<LeftOut>> leave_each_out(const HandEyeCalibration& calibration, const Lens& lens);

/// All corners with `margin_mm` about them.
PlaneExtent extent_of(const std::vector<BoardView>& views, int margin_mm);

struct BoardMappingCommand {
  HandEyeCommand hand_eye;      ///< pictures, poses, pattern, noise
  std::filesystem::path scope;  ///< empty: the camera is calibrated from these pictures
  TextureMode mode = TextureMode::perspective;
  double texel_mm = 0.05;
  std::vector<std::filesystem::path> still;  ///< recordings of tools at rest, for the tracking error
  std::filesystem::path page;  ///< a folder for page, pictures, and the files for `orcart paint`; empty: none
};

struct BoardMappingReport {
  std::string pattern, mode;
  std::vector<ViewMapping> views;
  TrackingError tracking;
  Statistics tip;        ///< one-dimensional: distances from the tip to the board's points, over all views
  Statistics tip_3d;     ///< one a view
  Statistics tip_along;  ///< one a view: along the optical axis
  double tip_picture_mm = 0;   ///< what the pictures leave open about their own tips: RMS in 3-D
  bool tip_is_window = false;  ///< the passport has X_CE; else the tip is the optical centre
  Statistics all, painting;    ///< over all corners; the mean's confidence is from the views' means
  Statistics origin;           ///< of the board's origin, one a view
  double lens_rms_mm = 0;      ///< over all views
  double tracker_floor_mm = 0;
  std::vector<LightStep> light;  ///< across seams of all views painted together
  std::vector<std::string> notes;
  std::vector<CaptionedPicture> pictures;
  double seconds = 0;
};

/// Told what is going on and how much of it is done, 0..1.
using MappingProgress = std::function<void(const std::string& what, double done)>;

Result<BoardMappingReport> evaluate_board(const BoardMappingCommand& command,
                                          const MappingProgress& progress);

std::string text_of(const BoardMappingReport& report);
std::string json_of(const BoardMappingReport& report);
/// DIR/mapping.html with its pictures beside it, and DIR/mapping.json.
Result<void> write_page(const std::filesystem::path& dir, const BoardMappingReport& report);

}  // namespace orcart
