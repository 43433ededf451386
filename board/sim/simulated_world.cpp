// The frames of a simulated operating room, and the pedal's and the tracker's events in it.
#include "board/sim/simulated_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "board/sim/lattice_noise.hpp"

namespace orcart {
namespace {

constexpr Nanos kPressAfterArrival = 200ms, kPressLength = 110ms, kDoublePress = 230ms, kHold = 1300ms;
constexpr Nanos kHidden = 1100ms, kBumpLength = 80ms;
constexpr double kBump_mm = 12, kBump_rad = 0.03;

double unit_number(std::uint64_t seed, std::uint32_t which) {
  return hash32(static_cast<std::uint32_t>(seed) * 2654435761U + which) / 4294967296.0;
}

Eigen::Matrix3d turned(std::uint64_t seed, std::uint32_t which, double widest_rad) {
  const Eigen::Vector3d about(unit_number(seed, which) - 0.5, unit_number(seed, which + 1) - 0.5,
                              unit_number(seed, which + 2) - 0.5);
  return Eigen::AngleAxisd(widest_rad * unit_number(seed, which + 3), about.normalized()).toRotationMatrix();
}

TrueToolPose as_tool(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_mm, bool visible) {
  return {.rotation = Eigen::Quaterniond(rotation), .translation_mm = translation_mm, .visible = visible};
}

void add_press(std::vector<PedalEdge>& edges, Instant at, Nanos length) {
  edges.push_back({.at = at, .kind = EdgeKind::pressed});
  edges.push_back({.at = at + length, .kind = EdgeKind::released});
}

}  // namespace

Result<SimulatedWorld> SimulatedWorld::create(const PlanRequest& request) {
  auto way = plan_way(request);
  if (!way) return tl::unexpected(way.error());
  return SimulatedWorld(ScopeMotion(std::move(*way), request.script), request);
}

SimulatedWorld::SimulatedWorld(ScopeMotion motion, const PlanRequest& request)
    : motion_(std::move(motion)), script_(request.script), scope_(request.scope) {
  // The reference is clamped to the head about 12 cm from the field; the position sensor stands 1.5 m away.
  X_MR_ = {.rotation = turned(script_.seed, 1, std::numbers::pi),
           .translation_mm = motion_.way().places.front().at_mm + Eigen::Vector3d(70, 60, 75)};
  X_TR_ = {.rotation = turned(script_.seed, 11, std::numbers::pi),
           .translation_mm = {80 * (unit_number(script_.seed, 21) - 0.5),
                              60 * (unit_number(script_.seed, 22) - 0.5),
                              -1500 + 100 * unit_number(script_.seed, 23)}};
  if (script_.hide_at >= 0) {
    const Nanos from = motion_.arrival(place_at(script_.hide_at)) + from_seconds(script_.rest_s);
    hidden_.push_back({.from = from, .until = from + kHidden});
  }
  if (script_.hide_second_at >= 0) {
    const Nanos from = from_seconds(script_.hide_second_at * script_.duration_s);
    second_hidden_.push_back({.from = from, .until = from + kHidden});
  }
}

std::size_t SimulatedWorld::place_at(double share) const {
  const auto places = static_cast<double>(motion_.way().places.size());
  return static_cast<std::size_t>(std::clamp(std::floor(share * places), 1.0, places - 1));
}

Pose<T, R> SimulatedWorld::X_TR(Instant at) const noexcept {
  const double at_s = seconds(at - start_);
  Pose<T, R> X = X_TR_;
  X.translation_mm.y() += 0.02 * std::sin(2 * std::numbers::pi * 0.25 * at_s);  // the patient breathes
  if (script_.bump_at < 0) return X;
  const double u = std::clamp((at_s - script_.bump_at * script_.duration_s) / seconds(kBumpLength), 0.0, 1.0);
  const double share = u * u * (3 - 2 * u);
  X.translation_mm += share * kBump_mm * Eigen::Vector3d(0.6, 0.0, 0.8);
  X.rotation = Eigen::AngleAxisd(share * kBump_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() * X.rotation;
  return X;
}

double SimulatedWorld::turn_rad(Instant at) const noexcept {
  if (!scope_.turning || script_.turn_rad == 0) return 0;
  const double turns = std::max(0.0, seconds(at - start_)) / script_.turn_every_s;
  return script_.turn_rad * (1 - 4 * std::abs(turns + 0.25 - std::floor(turns + 0.25) - 0.5));
}

Pose<T, S> SimulatedWorld::X_TS(Instant at) const noexcept {
  return X_TR(at) * X_MR_.inverse() * X_MC(at) * optics_at(scope_, turn_rad(at)).X_SC.inverse();
}

bool SimulatedWorld::seen(const std::vector<Stretch>& hidden, Instant at) const noexcept {
  return std::ranges::none_of(hidden, [&](const Stretch& gap) { return gap.holds(at - start_); });
}

// The second marker stands 40 mm beside the first, on the other side of the coupler.
TrueToolPose SimulatedWorld::pose_of(int tool, Instant at) const noexcept {
  if (tool == kReferenceTool) return as_tool(X_TR(at).rotation, X_TR(at).translation_mm, true);
  const Pose<T, S> X_TS = this->X_TS(at);
  if (tool == kScopeTool) return as_tool(X_TS.rotation, X_TS.translation_mm, seen(hidden_, at));
  if (tool != kSecondTool || !scope_.turning || !scope_.turning->R_SL)
    return as_tool(X_TS.rotation, X_TS.translation_mm, false);
  const bool slipped =
      script_.slip_second_at >= 0 && at >= start_ + from_seconds(script_.slip_second_at * script_.duration_s);
  const double carried_rad = turn_rad(at) + (slipped ? script_.slip_second_rad : 0);
  const Pose<S, L> X_SL{.rotation = second_marker_at(*scope_.turning, carried_rad),
                        .translation_mm = {40, 0, 0}};
  const Pose<T, L> X_TL = X_TS * X_SL;
  return as_tool(X_TL.rotation, X_TL.translation_mm, seen(second_hidden_, at));
}

std::vector<PedalEdge> SimulatedWorld::pedal_edges() const {
  std::vector<PedalEdge> edges;
  const auto is_at = [&](double share, std::size_t place) { return share >= 0 && place == place_at(share); };
  for (std::size_t i = 0; i < motion_.way().places.size(); ++i) {
    const Instant at = start_ + motion_.arrival(i) + kPressAfterArrival;
    const bool is_held = is_at(script_.stream_at, i);
    add_press(edges, at, is_held ? kHold : kPressLength);
    // In a short procedure both would fall upon one place, the second press into the hold.
    if (!is_held && is_at(script_.undo_at, i)) add_press(edges, at + kDoublePress, kPressLength);
  }
  return edges;
}

}  // namespace orcart
