// What the tracker said about one of its frames: where scope and reference were, and when.
#pragma once

#include <cstdint>
#include <optional>

#include "realtime/base/instant.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

enum class ToolState : std::uint8_t { unseen, seen, disabled, doubtful };

/// All tools from ONE device frame. The poses mean something only where their state is `seen`.
struct PoseSample {
  Instant measured_at{};  ///< host time of the device frame, by ClockFit, device latency already taken off
  Instant arrived_at{};   ///< host time at which the reply was complete
  std::uint32_t device_frame = 0;
  ToolState scope = ToolState::unseen;
  ToolState reference = ToolState::unseen;
  Pose<T, S> X_TS;
  Pose<T, R> X_TR;
  ToolState second = ToolState::unseen;  ///< a turning scope's second marker; unseen where it has none
  Pose<T, L> X_TL;
  std::optional<double> turn_rad;  ///< by both markers, where the turn is followed by them
  float scope_error_mm = 0;        ///< the device's own RMS of the marker fit
  float reference_error_mm = 0;

  bool complete() const { return scope == ToolState::seen && reference == ToolState::seen; }
  /// Scope marker in patient reference: the sensor itself drops out.
  Pose<R, S> X_RS() const { return X_TR.inverse() * X_TS; }
};

/// How a pose at an instant was found. Only exact and interpolated may paint.
enum class PoseKind : std::uint8_t { none, predicted, interpolated, exact };

struct PoseAnswer {
  PoseKind kind = PoseKind::none;
  Pose<R, S> X_RS;
  Nanos distance{};     ///< from the asked instant to the nearest sample used
  double turn_rad = 0;  ///< of the light post at that instant, where the samples tell it

  bool may_paint() const { return kind == PoseKind::exact || kind == PoseKind::interpolated; }
};

}  // namespace orcart
