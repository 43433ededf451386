// The window's place is the mean of what the camera sees more than was measured; each view judges the others.
#include "tools/calibration/tip.hpp"

#include <algorithm>
#include <cmath>

#include "tools/calibration/board_pose.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr double kFarthestScale = 0.05;

Result<void> check(const std::vector<TipView>& views) {
  if (views.size() < 3)
    return fail("too few views: " + std::to_string(views.size()) +
                " show the board at a known distance; three or more are accepted, five are good");
  double nearest = 1e9, farthest = 0;
  for (const TipView& view : views) {
    if (!(view.known_mm > 0))
      return fail(view.name +
                  json::format(": a distance of %g mm; positive ones are accepted", view.known_mm));
    nearest = std::min(nearest, view.known_mm), farthest = std::max(farthest, view.known_mm);
  }
  if (farthest < 0.5)
    return fail(json::format("the distances are %g to %g mm: probably metres; millimetres are accepted",
                             nearest, farthest));
  if (farthest < 1.2 * nearest)
    return fail(
        json::format("all distances are alike (%.1f to %.1f mm), so a board of another size would not be "
                     "noticed; distances "
                     "that differ by a fifth or more are accepted",
                     nearest, farthest));
  return {};
}

/// The slope of the camera's distances over the known ones, and its standard deviation.
void fit_scale(const std::vector<TipView>& views, TipFit& fit) {
  const auto count = static_cast<double>(views.size());
  double known = 0, seen = 0, spread2 = 0, both = 0, left2 = 0;
  for (const TipView& v : views) known += v.known_mm / count, seen += v.camera_mm / count;
  for (const TipView& v : views) {
    spread2 += (v.known_mm - known) * (v.known_mm - known);
    both += (v.known_mm - known) * (v.camera_mm - seen);
  }
  fit.scale = both / spread2;
  for (const TipView& v : views) left2 += std::pow(v.camera_mm - seen - fit.scale * (v.known_mm - known), 2);
  fit.scale_deviation = std::sqrt(left2 / std::max(1.0, count - 2) / spread2);
}

void measure(const std::vector<TipView>& views, TipFit& fit) {
  const auto count = static_cast<double>(views.size());
  double spread2 = 0, size2 = 0;
  for (const TipView& v : views) {
    const double off = v.camera_mm - v.known_mm - fit.window_mm;
    spread2 += off * off;
    fit.errors_mm.push_back(off * count / (count - 1));
    fit.mean_mm += std::abs(fit.errors_mm.back()) / count;
    fit.worst_mm = std::max(fit.worst_mm, std::abs(fit.errors_mm.back()));
  }
  for (const double error : fit.errors_mm) size2 += std::pow(std::abs(error) - fit.mean_mm, 2);
  fit.sd_mm = std::sqrt(size2 / (count - 1));
  fit.deviation_mm = std::sqrt(spread2 / (count - 1) / count);
}

}  // namespace

Result<double> axis_distance_mm(const Pose<C, B>& X_CB) {
  const Eigen::Vector3d normal = X_CB.rotation.col(2);
  if (std::abs(normal.z()) < 0.2)
    return fail(
        "the board is seen almost edge on; up to 78 degrees between its normal and the axis is accepted");
  return normal.dot(X_CB.translation_mm) / normal.z();
}

Result<TipFit> fit_tip(const std::vector<TipView>& views) {
  if (auto checked = check(views); !checked) return tl::unexpected(checked.error());
  TipFit fit;
  fit_scale(views, fit);
  const double off = std::abs(fit.scale - 1);
  if (off > kFarthestScale && off > 3 * fit.scale_deviation)
    return fail(
        json::format("the camera's distances grow %.3f times as fast as the known ones (+- %.3f); 0.95 to "
                     "1.05 is accepted: "
                     "is the pattern's size right, and are distances and pictures in one order?",
                     fit.scale, fit.scale_deviation));
  if (off > 0.01 && off > 3 * fit.scale_deviation)
    fit.notes.push_back(
        json::format("the camera's distances grow %.3f times as fast as the known ones", fit.scale));
  for (const TipView& v : views)
    fit.window_mm += (v.camera_mm - v.known_mm) / static_cast<double>(views.size());
  measure(views, fit);
  if (fit.window_mm < -0.5)
    fit.notes.push_back(json::format(
        "the window lies %.2f mm behind the optical centre, which lenses seldom do: were the distances taken "
        "from the window?",
        -fit.window_mm));
  return fit;
}

Result<TipCalibration> calibrate_tip(const TipCommand& command, const ScopeModel& scope,
                                     const Progress& progress) {
  if (command.distances_mm.size() != command.images.size())
    return fail("--distances names " + std::to_string(command.distances_mm.size()) + " distances for " +
                std::to_string(command.images.size()) + " pictures; one a picture is accepted");
  const auto seen = see_boards(command.images, command.pattern, progress);
  if (!seen) return tl::unexpected(seen.error());
  TipCalibration result{.scope = scope};
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < seen->views.size(); ++i) {
    const BoardView& view = seen->views[i];
    const std::string name = view.image.filename().string();
    if (auto sized = check_size(view, scope); !sized) return tl::unexpected(sized.error());
    if (view.corners.empty()) {
      notes.push_back(name + " is not used: " + view.remark);
      continue;
    }
    const auto X_CB = board_pose(view, scope.lens);
    if (!X_CB) return tl::unexpected(X_CB.error());
    const auto distance = axis_distance_mm(*X_CB);
    if (!distance) return fail(view.image.string() + ": " + distance.error().message);
    result.views.push_back({.name = name, .known_mm = command.distances_mm[i], .camera_mm = *distance});
  }
  auto fit = fit_tip(result.views);
  if (!fit) return tl::unexpected(fit.error());
  result.fit = std::move(*fit);
  result.fit.notes.insert(result.fit.notes.begin(), notes.begin(), notes.end());
  result.scope.X_CE = {};
  result.scope.X_CE.translation_mm.z() = result.fit.window_mm;
  return result;
}

}  // namespace orcart
