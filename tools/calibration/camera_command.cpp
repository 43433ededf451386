// Reads the pictures, solves, finds the mask, and falls back to fewer coefficients where the lens would fold
// the picture.
#include "tools/calibration/camera_command.hpp"

#include <atomic>
#include <chrono>
#include <ctime>
#include <future>
#include <mutex>

#include <opencv2/imgproc.hpp>

#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/camera_checks.hpp"
#include "tools/calibration/fall_off_fit.hpp"
#include "tools/calibration/hand_eye.hpp"
#include "tools/calibration/load_picture.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

std::vector<int> coefficient_ladder(LensModel model) {
  switch (model) {
    case LensModel::brown:
      return {5, 4, 2, 1};
    case LensModel::fisheye:
      return {4, 2};
    case LensModel::poly4:
      break;
  }
  return {3};
}

cv::Mat brightest(const std::vector<cv::Mat>& pictures) {
  cv::Mat lit, grey;
  for (const cv::Mat& picture : pictures) {
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    if (lit.empty()) {
      lit = grey.clone();
    } else {
      cv::max(lit, grey, lit);
    }
  }
  return lit;
}

/// Splits the views into those with a board and the others; distances and pictures follow.
void sort_out(SeenPictures& seen, CameraTask& task, CameraCalibration& result) {
  std::vector<cv::Mat> pictures;
  std::vector<double> distances;
  for (std::size_t i = 0; i < seen.views.size(); ++i) {
    if (seen.views[i].corners.empty()) {
      result.unused.push_back(seen.views[i]);
      continue;
    }
    result.views.push_back(seen.views[i]);
    pictures.push_back(seen.pictures[i]);
    if (!task.distances_mm.empty()) distances.push_back(task.distances_mm[i]);
  }
  seen.pictures = std::move(pictures);
  task.distances_mm = std::move(distances);
}

/// The model with as many coefficients as stay monotone to the mask's edge.
Result<void> solve(const cv::Mat& lit, CameraTask task, CameraCalibration& result) {
  const Eigen::Vector2i size(lit.cols, lit.rows);
  const std::vector<BoardView> views = result.views;
  for (const int coefficients : coefficient_ladder(task.model)) {
    task.coefficients = coefficients;
    result.views = views;
    auto fit = solve_camera(result.views, task);
    if (!fit) return tl::unexpected(fit.error());
    if (auto checked = check_fit(*fit, task); !checked) return checked;
    result.fit = std::move(*fit);
    result.mask = find_mask(lit, result.fit.lens.fy_px / result.fit.lens.fx_px);
    if (!monotone_to_edge(result.fit.lens, result.mask.mask, size)) continue;
    if (coefficients != coefficient_ladder(task.model).front())
      result.notes.push_back(json::format(
          "with more than %d coefficients the lens would fold the picture inside its mask", coefficients));
    return {};
  }
  return fail(
      "the lens folds the picture inside the mask's circle with every number of coefficients; add views with "
      "the board "
      "near the edge, or try another --model");
}

void fit_fall_off(const SeenPictures& seen, CameraCalibration& result) {
  std::vector<PaperPatch> patches;
  std::vector<double> distances;
  for (std::size_t v = 0; v < result.views.size(); ++v) {
    const auto more =
        paper_patches(seen.pictures[v], result.views[v], result.fit.views[v], result.fit.lens, v);
    patches.insert(patches.end(), more.begin(), more.end());
    distances.push_back(result.fit.views[v].distance_mm);
  }
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  result.scope.fall_off.reference_mm = std::clamp(distances[distances.size() / 2], 0.1, 1000.0);
  const auto power = vignetting_power(patches, result.views.size());
  result.vignetting_known = power.has_value();
  result.scope.fall_off.vignetting_cos_power = power.value_or(0);
}

/// How many corners count as one: what a lens model leaves over is alike in neighbours.
double alike(const CameraCalibration& result) {
  std::vector<HandEyeView> views;
  for (std::size_t v = 0; v < result.views.size(); ++v)
    views.push_back({.X_TS = {}, .X_CB = result.fit.views[v].X_CB, .board = result.views[v]});
  return corners_alike(views, result.fit.lens);
}

void fill_passport(const CameraCommand& command, CameraCalibration& result) {
  ScopeModel& scope = result.scope;
  const BoardView& first = result.views.front();
  scope.name = command.name;
  scope.serial = command.serial;
  scope.width_px = first.width_px, scope.height_px = first.height_px;
  scope.lens = result.fit.lens;
  scope.mask = result.mask.mask;
  scope.cone_half_angle_rad = cone_half_angle_rad(scope.lens, scope.mask, {first.width_px, first.height_px});
  scope.medium = command.medium;
  scope.calibrated_on = iso_date(0);
  scope.expires_on = iso_date(command.valid_days);
  scope.residual_px = result.fit.rms_px;
  scope.notch_rad = result.mask.notch_rad;
  if (result.fit.covariance) scope.lens_covariance = alike(result) * *result.fit.covariance;
}

}  // namespace

std::string iso_date(int days_later) {
  const std::time_t when = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() +
                                                                std::chrono::hours(24 * days_later));
  std::tm parts{};
  gmtime_r(&when, &parts);
  return json::format("%04d-%02d-%02d", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

Result<SeenPictures> see_boards(const std::vector<std::filesystem::path>& images, const Pattern& pattern,
                                const Progress& progress) {
  SeenPictures seen;
  seen.views.resize(images.size());
  seen.pictures.resize(images.size());
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex telling;
  const auto work = [&] {
    for (std::size_t i = next++; i < images.size(); i = next++) {
      seen.pictures[i] = load_picture(images[i]);
      if (!seen.pictures[i].empty()) seen.views[i] = find_board(seen.pictures[i], pattern);
      seen.views[i].image = images[i];
      const std::lock_guard lock(telling);
      if (progress) progress(++done, images.size(), images[i].filename().string());
    }
  };
  auto other = std::async(std::launch::async, work);
  work();
  other.wait();
  for (std::size_t i = 0; i < images.size(); ++i)
    if (seen.pictures[i].empty())
      return fail(images[i].string() + ": cannot be read as a picture; PNG, JPEG, TIFF and BMP are accepted");
  keep_one_numbering(seen.views);
  return seen;
}

Result<void> check_size(const BoardView& view, const ScopeModel& scope) {
  if (view.width_px == scope.width_px && view.height_px == scope.height_px) return {};
  return fail(view.image.string() + json::format(": %dx%d px; the scope's %dx%d are accepted", view.width_px,
                                                 view.height_px, scope.width_px, scope.height_px));
}

Result<CameraCalibration> calibrate_camera(const CameraCommand& command, const Progress& progress) {
  if (command.images.empty())
    return fail("no pictures were given; three or more pictures of the pattern are accepted");
  if (!command.distances_mm.empty() && command.distances_mm.size() != command.images.size())
    return fail("--distances names " + std::to_string(command.distances_mm.size()) + " distances for " +
                std::to_string(command.images.size()) + " pictures; one a picture is accepted");
  auto seen = see_boards(command.images, command.pattern, progress);
  if (!seen) return tl::unexpected(seen.error());
  if (auto checked = check_views(seen->views, command.pattern); !checked)
    return tl::unexpected(checked.error());
  const cv::Mat lit = brightest(seen->pictures);
  CameraCalibration result;
  CameraTask task{.model = command.model, .distances_mm = command.distances_mm};
  sort_out(*seen, task, result);
  const FoundMask square = find_mask(lit, 1);
  task.centre_px = square.circle ? Eigen::Vector2d(square.mask.cx_px, square.mask.cy_px)
                                 : Eigen::Vector2d(0.5 * (lit.cols - 1), 0.5 * (lit.rows - 1));
  if (auto solved = solve(lit, task, result); !solved) return tl::unexpected(solved.error());
  fit_fall_off(*seen, result);
  fill_passport(command, result);
  result.covered =
      coverage(result.views, result.scope.mask, result.scope.lens.fy_px / result.scope.lens.fx_px);
  result.hints = hints(result.views, result.fit, result.covered);
  return result;
}

}  // namespace orcart
