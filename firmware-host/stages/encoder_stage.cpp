// News are posted after the readings that they vouch for.
#include "firmware-host/stages/encoder_stage.hpp"

namespace orcart {

StepReport EncoderStage::step(Instant now) noexcept {
  StepReport report;
  bool all = hand_on();
  for (int i = 0; all; ++i) {
    if (i == kMostReadings) {
      all = false;
      break;
    }
    const auto reading = encoder_.take_reading();
    fault_.set(reading ? PortFault::nothing_yet : reading.error());
    if (!reading) break;
    in_hand_ = EncoderAngle{
        .at = reading->at,
        .angle_rad = static_cast<double>(reading->counts - scale_.counts_at_zero) * scale_.rad_per_count,
        .run = reading->run};
    ++report.items;
    all = hand_on();
  }
  news_.connected = fault_.get() == PortFault::nothing_yet;
  if (all && news_.connected) news_.heard_until = now;
  lanes_.encoder_news.post(news_);
  report.worked = report.items > 0;
  report.carried = !all;
  return report;
}

bool EncoderStage::hand_on() noexcept {
  if (in_hand_ && !lanes_.encoder_angles.try_push(*in_hand_)) return false;
  in_hand_.reset();
  return true;
}

}  // namespace orcart
