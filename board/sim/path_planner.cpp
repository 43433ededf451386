// Greedy planning: of all places with room, go next to the one that shows most new wall for the least way.
#include "board/sim/path_planner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include "board/sim/directions.hpp"
#include "board/sim/lumen.hpp"

namespace orcart {
namespace {

constexpr int kLookRays = 160;
constexpr float kNearest_mm = 4, kFurthest_mm = 38;  ///< wall nearer or further than that counts as not shown
constexpr float kPatch_mm = 2.5F;                    ///< coverage is counted in cubes of this size
constexpr double kFastest_mm_s = 36;
constexpr double kPeakOverMean = 1.875;  ///< of a minimum-jerk move (Flash and Hogan 1985)
constexpr std::size_t kMostCandidates = 1500;

using Patches = std::unordered_set<std::uint64_t>;

struct Candidate {
  RestingPlace place;
  std::vector<std::uint64_t> shows;  ///< patches of wall in its view
};

std::uint64_t patch_of(const Eigen::Vector3f& point) {
  const Eigen::Array3i cell = (point.array() / kPatch_mm).floor().cast<int>() + (1 << 20);
  return (static_cast<std::uint64_t>(cell.x()) << 42) | (static_cast<std::uint64_t>(cell.y()) << 21) |
         static_cast<std::uint64_t>(cell.z());
}

std::vector<std::uint64_t> shown_from(const PlanRequest& request, const RestingPlace& place) {
  const double half_angle = request.scope.cone_half_angle_rad > 0 ? request.scope.cone_half_angle_rad : 0.6;
  const auto directions = spiral_directions(place.view.cast<float>(), half_angle, kLookRays);
  std::vector<RayHit> hits(directions.size());
  const Eigen::Vector3f origin = place.at_mm.cast<float>();
  request.rays.nearest_many(origin, directions, kFurthest_mm, hits);
  std::vector<std::uint64_t> patches;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].distance_mm > kNearest_mm)
      patches.push_back(patch_of(origin + hits[i].distance_mm * directions[i]));
  std::ranges::sort(patches);
  patches.erase(std::ranges::unique(patches).begin(), patches.end());
  return patches;
}

/// The box about a surface's vertices, and its middle.
struct Extent {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F), high = Eigen::Vector3f::Constant(-1e9F);
  Eigen::Vector3d centre() const { return 0.5 * (low + high).cast<double>(); }
};

Extent extent_of(const TriangleMesh& mesh) {
  Extent extent;
  for (const Eigen::Vector3f& v : mesh.vertices_mm) {
    extent.low = extent.low.cwiseMin(v);
    extent.high = extent.high.cwiseMax(v);
  }
  return extent;
}

double outermost_mm(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  double furthest = 0;
  for (const Eigen::Vector3f& v : mesh.vertices_mm)
    furthest = std::max(furthest, (v.cast<double>() - from).dot(direction));
  return furthest;
}

/// Inside: a grid of points with room that the shaft reaches without leaning too far.
std::vector<RestingPlace> places_inside(const PlanRequest& request, const ScopeWay& way) {
  const Extent extent = extent_of(request.surface.mesh);
  const auto room = static_cast<float>(request.script.room_mm + 0.3);
  std::vector<Eigen::Vector3f> roomy;
  const float step = 1.6F;
  for (float x = extent.low.x(); x < extent.high.x(); x += step)
    for (float y = extent.low.y(); y < extent.high.y(); y += step)
      for (float z = extent.low.z(); z < extent.high.z(); z += step) {
        const Eigen::Vector3f p(x, y, z);
        if (inside(request.surface.mesh, request.rays, p) && clearance_mm(request.rays, p) >= room)
          roomy.push_back(p);
      }
  if (roomy.empty()) return {};
  const Eigen::Vector3f middle = std::accumulate(roomy.begin(), roomy.end(), Eigen::Vector3f(0, 0, 0)) /
                                 static_cast<float>(roomy.size());
  const Eigen::Vector3d axis = (middle.cast<double>() - way.entry_mm).normalized();
  std::vector<RestingPlace> places;
  for (const Eigen::Vector3f& p : roomy) {
    const Eigen::Vector3d view = (p.cast<double>() - way.entry_mm).normalized();
    const auto ahead = request.rays.nearest(p, view.cast<float>(), 1e4F);
    if (view.dot(axis) >= std::cos(request.script.widest_pivot_rad) && ahead &&
        ahead->distance_mm > 1.5F * kNearest_mm)
      places.push_back({.at_mm = p.cast<double>(), .view = view});
  }
  return places;
}

/// Outside: 25 to 40 mm above the points of the surface about the entry direction, looking down at them.
std::vector<RestingPlace> places_outside(const PlanRequest& request) {
  const Eigen::Vector3d centre = extent_of(request.surface.mesh).centre();
  const Eigen::Vector3d entry = request.script.entry_direction.normalized();
  std::vector<RestingPlace> places;
  int i = 0;
  for (const Eigen::Vector3f& direction : spiral_directions(entry.cast<float>(), 0.45, 500)) {
    const float start_mm =
        static_cast<float>(outermost_mm(request.surface.mesh, centre, direction.cast<double>())) + 1;
    const Eigen::Vector3f origin = centre.cast<float>() + start_mm * direction;
    const auto hit = request.rays.nearest(origin, -direction, 2 * start_mm);
    if (!hit) continue;
    const double height_mm = 26 + 2.4 * (i++ % 6);
    const Eigen::Vector3d view = -(direction.cast<double>() + 0.6 * entry).normalized();
    places.push_back(
        {.at_mm = (origin - hit->distance_mm * direction).cast<double>() - height_mm * view, .view = view});
  }
  return places;
}

std::vector<Candidate> candidates(const PlanRequest& request, std::vector<RestingPlace> places) {
  std::vector<Candidate> found;
  const std::size_t every = places.size() / kMostCandidates + 1;
  for (std::size_t i = request.script.seed % every; i < places.size(); i += every)
    found.push_back({.place = places[i], .shows = shown_from(request, places[i])});
  return found;
}

double gain_of(const Candidate& candidate, const Patches& seen) {
  return static_cast<double>(
      std::ranges::count_if(candidate.shows, [&](std::uint64_t patch) { return !seen.contains(patch); }));
}

double nearest_visit_mm(const Candidate& candidate, const std::vector<RestingPlace>& visited) {
  double nearest = 1e9;
  for (const RestingPlace& place : visited)
    nearest = std::min(nearest, (place.at_mm - candidate.place.at_mm).norm());
  return nearest;
}

/// The best next place after those visited: much new wall, away from where the scope has been, not far. Null
/// where none can be reached in one straight move.
const Candidate* best_next(const PlanRequest& request, const std::vector<Candidate>& all,
                           const std::vector<RestingPlace>& visited, const Patches& seen) {
  const RestingPlace& here = visited.back();
  const double move_s = request.script.press_every_s - request.script.rest_s;
  const double longest_mm = kFastest_mm_s * move_s / kPeakOverMean;
  const auto room = static_cast<float>(request.script.room_mm);
  std::vector<std::pair<double, const Candidate*>> order;
  for (const Candidate& candidate : all) {
    const double way_mm = (candidate.place.at_mm - here.at_mm).norm();
    if (way_mm < 1.5 || way_mm > longest_mm) continue;
    const double away_mm = std::min(nearest_visit_mm(candidate, visited), 5.0);
    order.emplace_back(gain_of(candidate, seen) + 0.8 * away_mm - 0.2 * way_mm, &candidate);
  }
  std::ranges::sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [score, candidate] : order)
    if (free_way(request.rays, here.at_mm.cast<float>(), candidate->place.at_mm.cast<float>(), room))
      return candidate;
  return nullptr;
}

}  // namespace

int places_in(const ProcedureScript& script) {
  return std::max(2, 1 + static_cast<int>((script.duration_s - 1.7) / script.press_every_s));
}

Result<ScopeWay> plan_way(const PlanRequest& request) {
  const ProcedureScript& script = request.script;
  ScopeWay way{.places = {}, .seen_from = script.seen_from};
  const Eigen::Vector3d direction = script.entry_direction.normalized();
  const Eigen::Vector3d centre = extent_of(request.surface.mesh).centre();
  way.entry_mm =
      centre + direction * (outermost_mm(request.surface.mesh, centre, direction) + script.entry_distance_mm);
  way.up = std::abs(direction.z()) < 0.85 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(0, -1, 0);
  const bool within = script.seen_from == SeenFrom::inside;
  const auto all = candidates(request, within ? places_inside(request, way) : places_outside(request));
  if (all.empty())
    return fail(
        within ? "the surface has no place inside with " + std::to_string(script.room_mm) +
                     " mm of room that a straight scope reaches; another entry_direction or surface would do"
               : "the entry direction meets no surface; point it from the centre to the craniotomy");
  Patches seen;
  // First where most can be seen; then on from there.
  const Candidate* next =
      &*std::ranges::max_element(all, {}, [](const Candidate& c) { return c.shows.size(); });
  for (int i = 0; i < places_in(script) && next != nullptr; ++i) {
    way.places.push_back(next->place);
    seen.insert(next->shows.begin(), next->shows.end());
    next = best_next(request, all, way.places, seen);
  }
  if (way.places.size() < 2)
    return fail("the scope has room at one place only; a smaller room_mm or a larger surface would do");
  while (static_cast<int>(way.places.size()) <
         places_in(script))  // go back and forth where there is nothing new
    way.places.push_back(way.places[way.places.size() - 2]);
  return way;
}

}  // namespace orcart
