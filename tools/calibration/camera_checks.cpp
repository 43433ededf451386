// Every refusal says which files and numbers, and what would be accepted.
#include "tools/calibration/camera_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr std::size_t kFewestViews = 3;
constexpr double kLeastTilt_rad = 0.1;

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

/// The mean distance between the same corners of two views; infinite where they share too few.
double apart_px(const BoardView& a, const BoardView& b) {
  std::map<std::pair<int, int>, Eigen::Vector2d> places;
  for (const BoardCorner& c : a.corners) places[{c.lattice.x(), c.lattice.y()}] = c.pixel_px;
  double sum = 0;
  std::size_t shared = 0;
  for (const BoardCorner& c : b.corners)
    if (const auto same = places.find({c.lattice.x(), c.lattice.y()}); same != places.end())
      sum += (same->second - c.pixel_px).norm(), ++shared;
  return 2 * shared < a.corners.size() || shared < 4 ? 1e9 : sum / static_cast<double>(shared);
}

/// Boards that are whole in most pictures and of one other size are another pattern.
Result<void> check_size(const std::vector<BoardView>& views, const Pattern& pattern) {
  if (pattern.kind == PatternKind::charuco) return {};
  std::map<std::pair<int, int>, std::size_t> sizes;
  std::size_t seen = 0;
  for (const BoardView& view : views) {
    if (view.columns == 0 || view.anchor == Anchor::sure) continue;
    ++seen;
    ++sizes[std::minmax(view.columns, view.rows)];
  }
  if (seen < 2) return {};
  const auto most = std::max_element(sizes.begin(), sizes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::pair<int, int> stated = std::minmax(pattern.columns, pattern.rows);
  if (most->first == stated || 3 * most->second < 2 * seen) return {};
  return fail(std::to_string(most->second) + " of " + std::to_string(seen) + " pictures show a pattern of " +
              std::to_string(most->first.second) + "x" + std::to_string(most->first.first) + ", not " +
              text_of(pattern) + "; state the pattern that was used");
}

}  // namespace

Result<void> check_views(const std::vector<BoardView>& views, const Pattern& pattern) {
  for (const BoardView& view : views)
    if (view.width_px != views.front().width_px || view.height_px != views.front().height_px)
      return fail(view.image.string() + ": " + std::to_string(view.width_px) + "x" +
                  std::to_string(view.height_px) + " px, but " + views.front().image.string() + " has " +
                  std::to_string(views.front().width_px) + "x" + std::to_string(views.front().height_px) +
                  "; pictures of one size are accepted");
  if (auto size = check_size(views, pattern); !size) return size;
  for (std::size_t a = 0; a < views.size(); ++a)
    for (std::size_t b = a + 1; b < views.size(); ++b)
      if (!views[a].corners.empty() && !views[b].corners.empty() && apart_px(views[a], views[b]) < 0.01)
        return fail(views[b].image.string() + ": the same view as " + views[a].image.string() +
                    "; each view once is accepted");
  std::size_t found = 0;
  std::string why;
  for (const BoardView& view : views) {
    if (!view.corners.empty()) ++found;
    if (view.corners.empty() && why.empty()) why = " (" + view.image.string() + ": " + view.remark + ")";
  }
  if (found < kFewestViews)
    return fail("too few views: the pattern " + text_of(pattern) + " was found in " + std::to_string(found) +
                " of " + std::to_string(views.size()) + " pictures" + why +
                "; three or more are accepted, ten at different tilts are good");
  return {};
}

Result<void> check_fit(const CameraFit& fit, const CameraTask& task) {
  double tilt = 0, nearest = 1e9, farthest = 0;
  for (const ViewFit& view : fit.views) {
    tilt = std::max(tilt, view.tilt_rad);
    nearest = std::min(nearest, view.distance_mm);
    farthest = std::max(farthest, view.distance_mm);
  }
  const bool one_distance = farthest < 1.05 * nearest;
  if (task.distances_mm.empty() && tilt < kLeastTilt_rad)
    return fail(
        json::format("no view is tilted (the most by %.1f degrees)%s, so the focal length stays open; tilt "
                     "the board by 20 to "
                     "40 degrees in some views, or give --distances",
                     degrees(tilt), one_distance ? " and all are at one distance" : ""));
  if (task.distances_mm.empty() && one_distance && tilt < 0.2)
    return fail(json::format(
        "all views are at one distance (%.1f to %.1f mm) and hardly tilted (%.1f degrees); add nearer and "
        "farther ones",
        nearest, farthest, degrees(tilt)));
  if (!fit.determined || fit.deviations[0] > 0.1 * fit.lens.fx_px)
    return fail(json::format(
        "the views leave the focal length open (%.0f +- %.0f px); add views tilted by 20 to 40 degrees in "
        "several directions",
        fit.lens.fx_px, fit.deviations[0]));
  return {};
}

double coverage(const std::vector<BoardView>& views, const CircularMask& mask, double aspect) {
  constexpr int kCells = 8;
  std::set<int> taken, all;
  const auto cell = [&](double x, double y) {
    return static_cast<int>(x / views.front().width_px * kCells) +
           kCells * static_cast<int>(y / views.front().height_px * kCells);
  };
  for (int i = 0; i < kCells * kCells; ++i) {
    const int column = i % kCells, row = i / kCells;
    const double x = (column + 0.5) * views.front().width_px / kCells,
                 y = (row + 0.5) * views.front().height_px / kCells;
    if (std::hypot(x - mask.cx_px, (y - mask.cy_px) / aspect) < mask.radius_px) all.insert(i);
  }
  for (const BoardView& view : views)
    for (const BoardCorner& c : view.corners)
      if (const int at = cell(c.pixel_px.x(), c.pixel_px.y()); all.contains(at)) taken.insert(at);
  return all.empty() ? 0 : static_cast<double>(taken.size()) / static_cast<double>(all.size());
}

std::vector<std::string> hints(const std::vector<BoardView>& views, const CameraFit& fit, double covered) {
  std::vector<std::string> said;
  double tilt = 0;
  for (const ViewFit& view : fit.views) tilt = std::max(tilt, view.tilt_rad);
  if (views.size() < 8)
    said.push_back(json::format("%zu views are few; add some, up to ten or more", views.size()));
  if (tilt < 0.35)
    said.push_back(
        json::format("the most tilted view has %.0f degrees; add some at 20 to 40", degrees(tilt)));
  if (covered < 0.7)
    said.push_back(json::format("corners cover %.0f %% of the view; add views with the board near its edge",
                                100 * covered));
  if (fit.deviations[0] > 0.01 * fit.lens.fx_px)
    said.push_back(
        json::format("the focal length is known to %.1f %% only", 100 * fit.deviations[0] / fit.lens.fx_px));
  for (std::size_t i = 0; i < views.size(); ++i)
    if (fit.views[i].rms_px > 2.5 * fit.rms_px)
      said.push_back(views[i].image.filename().string() +
                     json::format(" fits badly (%.2f px); was the board moving?", fit.views[i].rms_px));
  return said;
}

}  // namespace orcart
