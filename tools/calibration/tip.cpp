// The window's place is the mean of what the camera sees more than was measured; each view judges the others.
#include "tools/calibration/tip.hpp"

#include <algorithm>
#include <cmath>

#include "tools/calibration/board_pose.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/students_t.hpp"

namespace orcart {
namespace {

constexpr double kFarthestScale = 0.05;
constexpr double kNormal95 = 1.96;

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

/// The views' mean distance from the optical centre, mm.
Result<double> mean_distance_mm(const std::vector<const BoardView*>& views, const Lens& lens) {
  double sum = 0;
  for (const BoardView* view : views) {
    const auto X_CB = board_pose(*view, lens);
    if (!X_CB) return tl::unexpected(X_CB.error());
    const auto distance = axis_distance_mm(*X_CB);
    if (!distance) return tl::unexpected(distance.error());
    sum += *distance;
  }
  return sum / static_cast<double>(views.size());
}

/// What an uncertain lens makes of the window's place: all views move with it. Central differences of a tenth
/// of a standard deviation.
double deviation_by_lens_mm(const std::vector<const BoardView*>& views, const Lens& lens,
                            const LensCovariance& covariance) {
  constexpr double kStep = 0.1;
  LensStep slope = LensStep::Zero();
  for (int i = 0; i < kLensNumbers; ++i) {
    LensStep step = LensStep::Zero();
    step[i] = kStep * std::sqrt(covariance(i, i));
    if (step[i] <= 0) continue;
    const auto above = mean_distance_mm(views, stepped(lens, step)),
               below = mean_distance_mm(views, stepped(lens, -step));
    if (above && below) slope[i] = (*above - *below) / (2 * step[i]);
  }
  return std::sqrt(std::max(0.0, slope.dot(covariance * slope)));
}

std::optional<double> middle_beside_mm(const ScopeModel& scope, double window_mm) {
  const auto middle = direction_of(scope.lens, {scope.mask.cx_px, scope.mask.cy_px});
  if (!middle || !(scope.mask.radius_px > 0)) return std::nullopt;
  return std::abs(window_mm) * middle->head<2>().norm() / middle->z();
}

/// Few views know their own scatter badly: the deviation of both parts, as much wider as Student's 95 % is
/// than the normal one, with the degrees of freedom of the sum (Satterthwaite 1946).
double together_mm(double by_views_mm, std::size_t views, double by_lens_mm) {
  constexpr double kMostDegrees = 1e6;
  const double both_mm = std::hypot(by_views_mm, by_lens_mm);
  const double degrees =
      by_views_mm > 0 ? static_cast<double>(views - 1) * std::pow(both_mm / by_views_mm, 4) : kMostDegrees;
  return students_t(static_cast<std::size_t>(std::min(degrees, kMostDegrees))) / kNormal95 * both_mm;
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

Result<TipCalibration> calibrate_tip(const std::vector<BoardView>& views,
                                     const std::vector<double>& distances_mm, const ScopeModel& scope) {
  TipCalibration result{.scope = scope};
  std::vector<std::string> notes;
  std::vector<const BoardView*> used;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const BoardView& view = views[i];
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
    result.views.push_back({.name = name, .known_mm = distances_mm[i], .camera_mm = *distance});
    used.push_back(&view);
  }
  auto fit = fit_tip(result.views);
  if (!fit) return tl::unexpected(fit.error());
  result.fit = std::move(*fit);
  result.fit.notes.insert(result.fit.notes.begin(), notes.begin(), notes.end());
  if (scope.lens_covariance)
    result.lens_mm = deviation_by_lens_mm(used, scope.lens, *scope.lens_covariance);
  else
    result.fit.notes.emplace_back(
        "the passport does not say how well its lens is known, so what that adds to the window's place is "
        "left "
        "out: run orcart calibrate camera again");
  result.deviation_mm = together_mm(result.fit.deviation_mm, result.views.size(), result.lens_mm);
  result.middle_mm = middle_beside_mm(scope, result.fit.window_mm);
  result.scope.X_CE = {};
  result.scope.X_CE.translation_mm.z() = result.fit.window_mm;
  result.scope.window_covariance = Eigen::Matrix3d::Zero();
  (*result.scope.window_covariance)(2, 2) = result.deviation_mm * result.deviation_mm;
  return result;
}

Result<TipCalibration> calibrate_tip(const TipCommand& command, const ScopeModel& scope,
                                     const Progress& progress) {
  if (command.distances_mm.size() != command.images.size())
    return fail("--distances names " + std::to_string(command.distances_mm.size()) + " distances for " +
                std::to_string(command.images.size()) + " pictures; one a picture is accepted");
  const auto seen = see_boards(command.images, command.pattern, progress);
  if (!seen) return tl::unexpected(seen.error());
  return calibrate_tip(seen->views, command.distances_mm, scope);
}

}  // namespace orcart
