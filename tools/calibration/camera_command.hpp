// What `orcart calibrate camera` does: pictures of a board in, a scope's calibration passport and its figures
// out.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/camera_solver.hpp"
#include "tools/calibration/mask_finder.hpp"

namespace orcart {

struct CameraCommand {
  std::vector<std::filesystem::path> images;
  Pattern pattern;
  LensModel model = LensModel::brown;
  Medium medium = Medium::air;
  std::string name = "scope";
  std::string serial;                ///< as engraved; empty where it is not told
  std::vector<double> distances_mm;  ///< empty, or one an image
  int valid_days = 365;
};

struct CameraCalibration {
  ScopeModel scope;  ///< X_SC and X_CE are the identity until hand-eye calibration
  CameraFit fit;
  std::vector<BoardView> views;   ///< those used, in the order of fit.views
  std::vector<BoardView> unused;  ///< with the reason in their remark
  FoundMask mask;
  double covered = 0;  ///< part of the mask's cells that corners cover
  bool vignetting_known = false;
  std::vector<std::string> hints;  ///< what view would help most
  std::vector<std::string> notes;  ///< what was done that nobody asked for, e.g. a coefficient left out
};

using Progress = std::function<void(std::size_t done, std::size_t all, const std::string& what)>;

/// Pictures with their boards, in the order of the files. Refuses a file that is no picture. Works on two
/// files at a time.
struct SeenPictures {
  std::vector<BoardView> views;
  std::vector<cv::Mat> pictures;
};
Result<SeenPictures> see_boards(const std::vector<std::filesystem::path>& images, const Pattern& pattern,
                                const Progress& progress);

/// Refuses a picture that is not of the passport's size.
Result<void> check_size(const BoardView& view, const ScopeModel& scope);

Result<CameraCalibration> calibrate_camera(const CameraCommand& command, const Progress& progress);

/// Today, or so many days later, as ISO 8601.
std::string iso_date(int days_later);

}  // namespace orcart
