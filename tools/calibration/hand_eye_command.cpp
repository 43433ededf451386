// Boards are found, posed through the passport's lens, turned right way up, and handed to the solvers.
#include "tools/calibration/hand_eye_command.hpp"

#include <algorithm>
#include <map>

#include "tools/calibration/board_pose.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

/// Corners that the passport's lens contradicts: farther off than six robust deviations, and at least a
/// pixel.
void drop_outliers(BoardView& view, const Pose<C, B>& X_CB, const Lens& lens) {
  std::vector<double> off;
  for (const BoardCorner& c : view.corners) {
    const auto seen = project(lens, (X_CB * Point<B>{c.board_mm}).mm);
    off.push_back(seen ? (*seen - c.pixel_px).norm() : 1e9);
  }
  auto sorted = off;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = std::max(1.0, 6 * 0.85 * *middle);
  std::size_t next = 0;
  std::erase_if(view.corners, [&](const BoardCorner&) { return off[next++] > limit; });
}

/// The lens moves along only where that places views better that were left out.
Result<void> refine(const std::vector<HandEyeView>& views, const Lens& lens, const TrackerNoise& noise,
                    HandEyeCalibration& result) {
  RefineTask best{.noise = noise, .role = LensRole::held};
  best.corners_alike = corners_alike(views, lens);
  if (views.size() > 3) {
    RefineTask moved = best;
    moved.role = LensRole::refined;
    std::vector<double> held_each, moved_each;
    const auto held_mm = leave_one_out_mm(views, lens, best, &held_each);
    const auto moved_mm = leave_one_out_mm(views, lens, moved, &moved_each);
    const bool moves = moved_mm && (!held_mm || *moved_mm < *held_mm);
    if (moves) best = moved;
    if (held_mm || moved_mm) result.leave_one_out_mm = moves ? *moved_mm : *held_mm;
    result.left_out_mm = moves ? moved_each : held_each;
    result.notes.emplace_back(
        moves ? "the lens was refined along with the hand-eye pose"
              : "the lens was held: moving it along places views no better that were left out");
  }
  auto refined = refine_hand_eye(views, lens, best);
  if (!refined) return tl::unexpected(refined.error());
  result.refined = std::move(*refined);
  result.spread = hand_eye_spread(views, result.refined, best);
  result.floor_mm = tracker_floor_mm(views, result.refined, noise);
  result.least_left_out_mm = least_left_out_mm(views, result.refined.X_SC);
  result.views = views;
  result.task = best;
  return {};
}

/// What the passport said of another lens, or of another hand-eye, is not true of these.
void take_spread(HandEyeCalibration& result) {
  result.scope.hand_eye_covariance.reset();
  if (result.task.role == LensRole::refined) result.scope.lens_covariance.reset();
  if (!result.spread) {
    result.notes.emplace_back("the views leave open how far the hand-eye may be off; more views tell");
    return;
  }
  result.scope.hand_eye_covariance = result.spread->hand_eye;
  if (result.spread->lens) result.scope.lens_covariance = result.spread->lens;
}

}  // namespace

Result<std::vector<Pose<T, S>>> poses_of_pictures(const std::vector<std::filesystem::path>& images,
                                                  const PosesFile& poses, const std::filesystem::path& file) {
  std::map<std::string, Pose<T, S>> by_name;
  bool named = false;
  for (const NamedPose& pose : poses.poses) {
    by_name[pose.name] = pose.X_TS;
    named = named || !pose.numbered;
  }
  std::vector<Pose<T, S>> result;
  std::string missing;
  for (const auto& image : images) {
    auto found = by_name.find(image.filename().string());
    if (found == by_name.end()) found = by_name.find(image.stem().string());
    if (found != by_name.end())
      result.push_back(found->second);
    else
      missing += (missing.empty() ? "" : ", ") + image.filename().string();
  }
  if (result.size() == images.size()) return result;
  if (named && !result.empty())
    return fail(file.string() + ": names some of the pictures, but has no pose named " + missing +
                "; a pose for each picture is accepted");
  if (poses.poses.size() != images.size())
    return fail(file.string() + ": " + std::to_string(poses.poses.size()) + " poses for " +
                std::to_string(images.size()) +
                " pictures; one a picture, by its name or in order, is accepted");
  result.clear();
  for (const NamedPose& pose : poses.poses) result.push_back(pose.X_TS);
  return result;
}

Result<HandEyeCalibration> calibrate_hand_eye(const HandEyeCommand& command, const ScopeModel& scope,
                                              const Progress& progress) {
  constexpr double kLargestScatter_mm = 8;
  if (command.noise.poses_in == PosesIn::reference && command.noise.depth_ratio != 1)
    return fail(
        "--depth-ratio is along the sensor's z, which poses in the reference do not know; it goes with "
        "--poses-in tracker");
  const auto poses = read_poses(command.poses);
  if (!poses) return tl::unexpected(poses.error());
  const auto X_TS = poses_of_pictures(command.images, *poses, command.poses);
  if (!X_TS) return tl::unexpected(X_TS.error());
  const auto seen = see_boards(command.images, command.pattern, progress);
  if (!seen) return tl::unexpected(seen.error());
  HandEyeCalibration result{.scope = scope, .notes = poses->notes};
  std::vector<HandEyeView> views;
  for (std::size_t i = 0; i < seen->views.size(); ++i) {
    BoardView view = seen->views[i];
    const std::string name = view.image.filename().string();
    if (auto sized = check_size(view, scope); !sized) return tl::unexpected(sized.error());
    if (view.corners.empty() || view.anchor == Anchor::none) {
      result.notes.push_back(
          name + " is not used: " +
          (view.corners.empty() ? view.remark : view.remark + ", which corner is which cannot be told"));
      continue;
    }
    auto X_CB = board_pose(view, scope.lens);
    if (!X_CB) return tl::unexpected(X_CB.error());
    drop_outliers(view, *X_CB, scope.lens);
    X_CB = board_pose(view, scope.lens);
    if (!X_CB) return tl::unexpected(X_CB.error());
    views.push_back({.X_TS = (*X_TS)[i], .X_CB = *X_CB, .board = view});
    result.names.push_back(name);
  }
  settle_turns(views, command.pattern);
  auto closed = hand_eye_closed_form(views);
  if (!closed) return tl::unexpected(closed.error());
  result.closed_form = std::move(*closed);
  if (auto refined = refine(views, scope.lens, command.noise, result); !refined)
    return tl::unexpected(refined.error());
  if (result.refined.scatter_mm > kLargestScatter_mm) {
    const auto worst = std::max_element(result.refined.scatters_mm.begin(), result.refined.scatters_mm.end());
    return fail(json::format(
        "the board scatters by %.1f mm RMS (most in %s): it or its reference moved, or poses and pictures do "
        "not belong "
        "together; up to %.0f mm is accepted",
        result.refined.scatter_mm,
        result.names[static_cast<std::size_t>(worst - result.refined.scatters_mm.begin())].c_str(),
        kLargestScatter_mm));
  }
  if (scope.X_CE.rotation.isIdentity(0) && scope.X_CE.translation_mm.isZero(0))
    result.notes.emplace_back(
        "X_CE is not known yet, so the window counts as the optical centre: run orcart calibrate tip");
  result.scope.lens = result.refined.lens;
  result.scope.X_SC = result.refined.X_SC;
  take_spread(result);
  result.scope.residual_mm = result.leave_one_out_mm.value_or(result.refined.scatter_mm);
  return result;
}

}  // namespace orcart
