// Normalised cross-correlation of two patches of surface, with the best shift found to a fraction of a step.
#include "tools/evaluate/consistency.hpp"

#include <algorithm>
#include <cmath>

#include "tools/evaluate/error_chain.hpp"

namespace orcart {

namespace {

/// Square grid of greys on a tangent plane.
struct Patch {
  int edge = 0;
  std::vector<float> grey;
  /// How many places above and left of a corner the picture does not show; (edge + 1) squared.
  std::vector<int> unseen;

  int unseen_within(int x, int y, int size) const {
    const auto at = [&](int i, int j) { return unseen[static_cast<std::size_t>(j * (edge + 1) + i)]; };
    return at(x + size, y + size) - at(x, y + size) - at(x + size, y) + at(x, y);
  }
};

double grey_at(const Picture& picture, const Eigen::Vector2d& pixel) {
  const double x = std::clamp(pixel.x(), 0.0, picture.width_px - 1.001),
               y = std::clamp(pixel.y(), 0.0, picture.height_px - 1.001);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto at = [&](int i, int j) {
    const std::uint8_t* p =
        picture.rgba.data() + 4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width_px) +
                                   static_cast<std::size_t>(i));
    return 0.3 * p[0] + 0.6 * p[1] + 0.1 * p[2];
  };
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

const ScopeModel& scope_of(const EvaluationScene& scene, const TakenPicture& taken) {
  return taken.scope != nullptr ? *taken.scope : scene.scope;
}

std::optional<Eigen::Vector2d> seen_at(const ScopeModel& scope, const Pose<M, C>& X_MC,
                                       const Eigen::Vector3d& place_mm) {
  const Eigen::Vector3d p_C = X_MC.rotation.transpose() * (place_mm - X_MC.translation_mm);
  const auto pixel = project(scope.lens, p_C);
  const CircularMask& mask = scope.mask;
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  if (!pixel || std::hypot(pixel->x() - mask.cx_px, (pixel->y() - mask.cy_px) / aspect) >
                    mask.radius_px - mask.soft_edge_px)
    return std::nullopt;
  return pixel;
}

/// The grey of a place of the tangent plane, put onto the surface along the normal, so that a curved wall is
/// no error; nothing where the picture does not show it.
std::optional<double> grey_on_surface(const EvaluationScene& scene, const TakenPicture& taken,
                                      const Landmark& at, const Eigen::Vector3d& flat) {
  constexpr float kLiftMm = 2;
  const auto hit = scene.rays.nearest((flat + static_cast<double>(kLiftMm) * at.normal).cast<float>(),
                                      (-at.normal).cast<float>(), 2 * kLiftMm);
  if (!hit) return std::nullopt;
  const Eigen::Vector3d place = flat + static_cast<double>(kLiftMm - hit->distance_mm) * at.normal;
  const auto pixel = seen_at(scope_of(scene, taken), taken.X_MC, place);
  if (!pixel || scene.rays.hidden(taken.X_MC.translation_mm.cast<float>(), place.cast<float>(), 0.2F))
    return std::nullopt;
  return grey_at(taken.picture, *pixel);
}

Patch patch_of(const EvaluationScene& scene, const TakenPicture& taken, const Landmark& at, double half_mm,
               double step_mm) {
  const auto tangents = tangents_of(at.normal);
  const int steps = static_cast<int>(std::lround(half_mm / step_mm));
  Patch patch{.edge = 2 * steps + 1, .grey = {}, .unseen = {}};
  const auto width = static_cast<std::size_t>(patch.edge + 1);
  patch.unseen.assign(width * width, 0);
  for (int j = 0; j < patch.edge; ++j)
    for (int i = 0; i < patch.edge; ++i) {
      const Eigen::Vector3d flat =
          at.place_mm + tangents * Eigen::Vector2d((i - steps) * step_mm, (j - steps) * step_mm);
      const auto grey = grey_on_surface(scene, taken, at, flat);
      patch.grey.push_back(static_cast<float>(grey.value_or(0)));
      const std::size_t here = static_cast<std::size_t>(j + 1) * width + static_cast<std::size_t>(i + 1);
      patch.unseen[here] = patch.unseen[here - 1] + patch.unseen[here - width] -
                           patch.unseen[here - width - 1] + (grey ? 0 : 1);
    }
  return patch;
}

constexpr double kUnknown = -2;  ///< in place of a correlation

/// The correlation of a with b's part that lies (dx, dy) samples off its middle; unknown where b does not
/// show it whole.
double correlation(const Patch& a, const Patch& b, int dx, int dy) {
  const int middle = b.edge / 2, half = a.edge / 2;
  if (b.unseen_within(middle - half + dx, middle - half + dy, a.edge) > 0) return kUnknown;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int j = 0; j < a.edge; ++j)
    for (int i = 0; i < a.edge; ++i) {
      const double x = static_cast<double>(a.grey[static_cast<std::size_t>(j * a.edge + i)]);
      const double y = static_cast<double>(
          b.grey[static_cast<std::size_t>((middle - half + j + dy) * b.edge + middle - half + i + dx)]);
      sa += x;
      sb += y;
      saa += x * x;
      sbb += y * y;
      sab += x * y;
    }
  const double n = static_cast<double>(a.grey.size());
  const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
  constexpr double kLeastVariance = 1.5;  // grey steps squared: a patch without texture tells nothing
  if (va < kLeastVariance * n || vb < kLeastVariance * n) return -1;
  return (sab - sa * sb / n) / std::sqrt(va * vb);
}

/// The top of a parabola through three values, in steps from the middle one.
double top_of(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

constexpr double kLeastLead = 0.1;  ///< over every other place: where several are alike, none is known

/// The largest of a square of correlations farther than half a millimetre from its top.
double best_elsewhere(const std::vector<double>& map, int side, int top, double step_mm) {
  constexpr double kNear_mm = 0.5;
  double best = -1;
  for (int i = 0; i < side * side; ++i)
    if (std::hypot(i % side - top % side, i / side - top / side) * step_mm > kNear_mm)
      best = std::max(best, map[static_cast<std::size_t>(i)]);
  return best;
}

std::optional<PatchShift> shift_of(const Patch& a, const Patch& b, const Landmark& at, double step_mm) {
  const int reach = (b.edge - a.edge) / 2;
  const int side = 2 * reach + 1;
  std::vector<double> map;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) map.push_back(correlation(a, b, dx, dy));
  const auto top = static_cast<int>(std::max_element(map.begin(), map.end()) - map.begin());
  const int best_x = top % side - reach, best_y = top / side - reach;
  const double best = map[static_cast<std::size_t>(top)];
  constexpr double kLeast = 0.7;
  if (best < kLeast || std::abs(best_x) == reach || std::abs(best_y) == reach) return std::nullopt;
  if (best - best_elsewhere(map, side, top, step_mm) < kLeastLead) return std::nullopt;
  // A best shift beside what is not seen may be none: the true one could lie there.
  for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
    if (correlation(a, b, best_x + dx, best_y + dy) == kUnknown) return std::nullopt;
  const Eigen::Vector2d steps(
      best_x + top_of(correlation(a, b, best_x - 1, best_y), best, correlation(a, b, best_x + 1, best_y)),
      best_y + top_of(correlation(a, b, best_x, best_y - 1), best, correlation(a, b, best_x, best_y + 1)));
  return PatchShift{
      .place_mm = at.place_mm, .shift_mm = step_mm * steps, .normal = at.normal, .correlation = best};
}

}  // namespace

PairConsistency compare(const EvaluationScene& scene, const TakenPicture& first, const TakenPicture& second,
                        const ConsistencySettings& settings, RandomStream& random) {
  PairConsistency pair;
  const auto places = landmarks_of_chance(through(scene, scope_of(scene, first)), first.X_MC,
                                          static_cast<std::size_t>(settings.patches), random);
  for (const Landmark& place : places) {
    const Patch a = patch_of(scene, first, place, settings.patch_mm / 2, settings.step_mm);
    if (a.unseen_within(0, 0, a.edge) > 0) continue;
    const Patch b =
        patch_of(scene, second, place, settings.patch_mm / 2 + settings.reach_mm, settings.step_mm);
    const int off = (b.edge - a.edge) / 2;
    if (b.unseen_within(off, off, a.edge) > 0) continue;
    ++pair.looked_at;
    if (const auto shift = shift_of(a, b, place, settings.step_mm)) pair.patches.push_back(*shift);
  }
  std::vector<double> lengths;
  for (const PatchShift& patch : pair.patches) lengths.push_back(patch.shift_mm.norm());
  if (lengths.empty()) return pair;
  std::sort(lengths.begin(), lengths.end());
  pair.median_mm = lengths[lengths.size() / 2];
  pair.p95_mm = lengths[std::min(lengths.size() - 1, lengths.size() * 95 / 100)];
  return pair;
}

}  // namespace orcart
