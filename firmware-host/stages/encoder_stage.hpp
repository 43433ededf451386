// Reads a turn encoder and hands on where it stands. Thread: pedal. Rate: the pedal's, at least every 5 ms.
// Budget: topology, row "encoder".
#pragma once

#include <cstdint>
#include <optional>

#include "board/ports/turn_encoder.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/stages/watched_fault.hpp"
#include "realtime/kernel/stage.hpp"

namespace orcart {

/// What counts mean.
struct EncoderScale {
  double rad_per_count = 0;         ///< below 0 where counts fall as the turn rises
  std::int64_t counts_at_zero = 0;  ///< of an absolute encoder, at the passport's turn
};

class EncoderStage final : public Stage {
 public:
  EncoderStage(TurnEncoder& encoder, const EncoderScale& scale, Lanes& lanes)
      : encoder_(encoder), scale_(scale), lanes_(lanes) {}

  std::string_view name() const noexcept override { return "encoder"; }
  StepReport step(Instant now) noexcept override;

  /// nothing_yet while the encoder is there. Any thread.
  PortFault fault() const noexcept { return fault_.get(); }

  static constexpr int kMostReadings = 128;  ///< of one step; more wait for the next

 private:
  /// False where the lane is full: the angle is kept for the next step.
  bool hand_on() noexcept;

  TurnEncoder& encoder_;
  EncoderScale scale_;
  Lanes& lanes_;
  WatchedFault fault_;
  std::optional<EncoderAngle> in_hand_;
  EncoderNews news_;
};

}  // namespace orcart
