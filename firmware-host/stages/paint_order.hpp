// What the mapping thread asks of the painter: every frame is shown once and then painted or let go, in this
// order.
#pragma once

#include <cstdint>
#include <optional>

#include "realtime/geometry/twist.hpp"
#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/pose_sample.hpp"
#include "realtime/sync/refusal.hpp"

namespace orcart {

enum class PaintOrderKind : std::uint8_t {
  show,         ///< this is the newest picture; hold its buffer until `paint` or `release` has come as well
  paint,        ///< paint this frame onto patch `patch`; with the view's last part the frame is free
  release,      ///< nothing is painted from this frame
  acknowledge,  ///< the pedal was pressed: say so on the panel
  cancel,       ///< take back unit `request.unit` if it was painted
  undo,         ///< take back the newest unit
  stream_end,   ///< the pedal was let go
  fail,         ///< a capture was refused: say so on the panel
  warn,         ///< the pedal is stuck, or lost an edge
};

struct PaintOrder {
  PaintOrderKind kind = PaintOrderKind::show;
  CapturedFrame frame;              ///< show, paint, release
  CaptureRequest request;           ///< paint, acknowledge, cancel, fail
  Refusal refusal = Refusal::none;  ///< fail
  std::uint32_t patch = 0;          ///< paint: slot of the patch
  Pose<M, C> X_MC;                  ///< paint
  double turn_rad = 0;              ///< paint: of the light post since the passport's turn
  PoseKind pose_kind = PoseKind::none;
  Nanos pose_distance{};  ///< paint: from mid-exposure to the nearest sample
  std::optional<Twist>
      velocity;          ///< paint: of C by the marker's movement, mm/s and rad/s in C; nothing: not known
  Instant matched_at{};  ///< when the pose bracket was in hand
  Instant mapped_at{};   ///< when the patch was ready
};

}  // namespace orcart
