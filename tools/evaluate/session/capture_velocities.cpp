// A stream's captures are their own track.
#include "tools/evaluate/session/capture_velocities.hpp"

#include <optional>

#include "tools/evaluate/error_chain.hpp"

namespace orcart {
namespace {

Instant mid_exposure(const StoredCapture& capture) {
  return capture.exposure_start + (capture.exposure_end - capture.exposure_start) / 2;
}

std::optional<Twist> by_neighbours(const std::vector<StoredCapture>& captures, std::size_t i) {
  constexpr Nanos kNear = 150ms;
  const auto near = [&](std::size_t other) {
    const Nanos apart = mid_exposure(captures[other]) - mid_exposure(captures[i]);
    return captures[other].facts.unit == captures[i].facts.unit && apart < kNear && apart > -kNear;
  };
  const std::size_t first = i > 0 && near(i - 1) ? i - 1 : i,
                    last = i + 1 < captures.size() && near(i + 1) ? i + 1 : i;
  const double span_s = seconds(mid_exposure(captures[last]) - mid_exposure(captures[first]));
  if (!(span_s > 0)) return std::nullopt;
  return twist_between(captures[first].facts.X_MC, captures[last].facts.X_MC) / span_s;
}

}  // namespace

std::vector<Twist> capture_velocities(const std::vector<StoredCapture>& captures, const ErrorModel& model,
                                      VelocitySources& sources) {
  std::vector<Twist> velocities;
  velocities.reserve(captures.size());
  for (std::size_t i = 0; i < captures.size(); ++i) {
    std::optional<Twist> velocity = captures[i].facts.velocity;
    ++(velocity ? sources.stored : sources.assumed);
    if (!velocity && (velocity = by_neighbours(captures, i))) --sources.assumed, ++sources.neighbours;
    if (velocity) {
      sources.speed_mm_s += velocity->head<3>().norm();
      sources.turn_rad_s += velocity->tail<3>().norm();
    }
    velocities.push_back(velocity.value_or(assumed_velocity(model)));
  }
  if (const auto known = static_cast<double>(sources.stored + sources.neighbours); known > 0)
    sources.speed_mm_s /= known, sources.turn_rad_s /= known;
  return velocities;
}

}  // namespace orcart
