// Means and words.
#include "tools/evaluate/view_velocities.hpp"

#include "tools/registration/json_text.hpp"

namespace orcart {

Capture capture_of(const View& view, const ErrorModel& model) {
  return {.X_MC = view.X_MC, .velocity = view.velocity.value_or(assumed_velocity(model))};
}

ViewVelocities velocities_of(const std::vector<View>& views) {
  ViewVelocities velocities;
  for (const View& view : views) {
    ++(view.velocity ? velocities.told : velocities.assumed);
    if (!view.velocity) continue;
    velocities.speed_mm_s += view.velocity->head<3>().norm();
    velocities.turn_rad_s += view.velocity->tail<3>().norm();
  }
  if (const auto told = static_cast<double>(velocities.told); told > 0)
    velocities.speed_mm_s /= told, velocities.turn_rad_s /= told;
  return velocities;
}

std::string text_of(const ViewVelocities& v) {
  return json::format("velocity: of %zu views told, of %zu assumed", v.told, v.assumed) +
         (v.told > 0 ? json::format("; those told move by %.1f mm/s and %.3f rad/s in the mean", v.speed_mm_s,
                                    v.turn_rad_s)
                     : "");
}

std::string json_of(const ViewVelocities& v) {
  return json::format("{\"told\": %zu, \"assumed\": %zu, \"mean_mm_s\": %.3f, \"mean_rad_s\": %.4f}", v.told,
                      v.assumed, v.speed_mm_s, v.turn_rad_s);
}

}  // namespace orcart
