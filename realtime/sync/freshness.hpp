// LIVE, STALE or LOST, from source stamps alone: old data is never shown as live.
#pragma once

#include <algorithm>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

enum class Liveness : std::uint8_t { lost, stale, live };

/// A stamp from further ahead than this is no stamp.
inline constexpr Nanos kStampTolerance = 1ms;

/// What is live, by the periods of the sources. Every question is answered from a stamp of the source and the
/// clock; Instant{} stands for a stamp that never came.
struct FreshnessRules {
  Nanos tracker_period{};  ///< of the polled samples
  Nanos video_period{};

  /// `last_reply`: arrival of the newest reply of any kind. Stale, no more paint: silent for max(50 ms, 3
  /// periods); lost: for max(100 ms, 4 periods).
  constexpr Liveness tracker(Instant now, Instant last_reply) const noexcept {
    return of(now - last_reply, std::max<Nanos>(50ms, 3 * tracker_period),
              std::max<Nanos>(100ms, 4 * tracker_period));
  }
  /// `last_complete`: arrival of the newest sample in which scope and reference were both seen; not older
  /// than a period + 5 ms.
  constexpr bool tool_seen(Instant now, Instant last_complete) const noexcept {
    const Nanos age = now - last_complete;
    return age >= -kStampTolerance && age <= tracker_period + 5ms;
  }
  /// `last_frame`: exposure end of the newest frame. Stale: none for max(100 ms, 3 periods); lost, NO LIVE
  /// VIDEO: for max(250 ms, 6 periods).
  constexpr Liveness video(Instant now, Instant last_frame) const noexcept {
    return of(now - last_frame, std::max<Nanos>(100ms, 3 * video_period),
              std::max<Nanos>(250ms, 6 * video_period));
  }
  /// 1.5 periods without a new frame: to be counted.
  constexpr bool video_overdue(Instant now, Instant last_frame) const noexcept {
    return now - last_frame >= video_period * 3 / 2;
  }

 private:
  static constexpr Liveness of(Nanos age, Nanos stale_at, Nanos lost_at) noexcept {
    if (age < -kStampTolerance || age >= lost_at) return Liveness::lost;
    return age >= stale_at ? Liveness::stale : Liveness::live;
  }
};

}  // namespace orcart
