// A count is as likely anywhere within its width.
#include "firmware-host/app/turn_deviation.hpp"

#include <cmath>

#include "firmware-host/stages/view_errors.hpp"

namespace orcart {

double turn_deviation_rad(const CartConfig& config, const Turning& turning, const NdiSettings& tracker) {
  if (config.turn_deviation_rad) return *config.turn_deviation_rad;
  if (config.turn == TurnSource::marker)
    return marked_turn_deviation_rad(turning, ndi::markers_of(tracker.tools[0].definition),
                                     ndi::markers_of(tracker.tools[2].definition), config.marker_rms_mm());
  const double picture_rad = turning.notch_deviation_rad.value_or(kAssumedErrors.light_post_rad);
  if (config.turn != TurnSource::encoder) return picture_rad;
  return std::hypot(picture_rad, scale_of(config.encoder).rad_per_count / std::sqrt(12.0));
}

}  // namespace orcart
