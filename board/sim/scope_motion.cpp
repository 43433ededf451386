// Minimum-jerk moves (Flash and Hogan 1985: 10 u^3 - 15 u^4 + 6 u^5) with what a hand adds to them.
#include "board/sim/scope_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orcart {
namespace {

constexpr double kFirstArrival_s = 1.0;

double wave(double at_s, double hz, double phase) {
  return std::sin(2 * std::numbers::pi * hz * at_s + phase);
}

/// Slow drift and tremor of a hand, mm, for a tremor of 1 mm; each axis at rates of its own.
Eigen::Vector3d hand(double at_s, double seed) {
  return {3 * wave(at_s, 0.31, seed) + 2 * wave(at_s, 0.83, 2.1 * seed) + wave(at_s, 8.7, 1),
          3 * wave(at_s, 0.23, 1.3 * seed) + 2 * wave(at_s, 0.71, 3.7 * seed) + wave(at_s, 9.4, 2),
          3 * wave(at_s, 0.37, 1.7 * seed) + 2 * wave(at_s, 0.61, 0.9 * seed) + wave(at_s, 8.1, 3)};
}

}  // namespace

Nanos ScopeMotion::arrival(std::size_t place) const noexcept {
  return from_seconds(kFirstArrival_s + static_cast<double>(place) * script_.press_every_s);
}

RestingPlace ScopeMotion::between_places(double at_s) const noexcept {
  const double in_places = (at_s - kFirstArrival_s) / script_.press_every_s;
  const auto last = static_cast<double>(way_.places.size() - 1);
  const double leaving = std::clamp(std::floor(in_places), 0.0, last);
  const auto from = static_cast<std::size_t>(leaving);
  const std::size_t to = std::min(from + 1, way_.places.size() - 1);
  const double since_arrival_s = at_s - kFirstArrival_s - leaving * script_.press_every_s;
  const double u =
      std::clamp((since_arrival_s - script_.rest_s) / (script_.press_every_s - script_.rest_s), 0.0, 1.0);
  const double share = u * u * u * (10 + u * (6 * u - 15));
  const RestingPlace &a = way_.places[from], &b = way_.places[to];
  return {.at_mm = a.at_mm + share * (b.at_mm - a.at_mm),
          .view = (a.view + share * (b.view - a.view)).normalized()};
}

Pose<M, C> ScopeMotion::X_MC(Nanos since_start) const noexcept {
  const double at_s = std::clamp(seconds(since_start), 0.0, script_.duration_s);
  const auto phase = static_cast<double>(script_.seed % 97);
  RestingPlace now = between_places(at_s);
  now.at_mm += script_.tremor_mm * hand(at_s, phase);
  if (way_.seen_from == SeenFrom::inside) now.view = (now.at_mm - way_.entry_mm).normalized();
  const Eigen::Vector3d down = -(way_.up - way_.up.dot(now.view) * now.view).normalized();
  Pose<M, C> X_MC{.rotation = {}, .translation_mm = now.at_mm};
  X_MC.rotation << down.cross(now.view), down, now.view;
  X_MC.rotation *= Eigen::AngleAxisd(script_.sway_rad * wave(at_s, 1 / 11.0, phase), Eigen::Vector3d::UnitZ())
                       .toRotationMatrix();
  return X_MC;
}

}  // namespace orcart
