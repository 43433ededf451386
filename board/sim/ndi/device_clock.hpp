// The emulated tracker's own clock: it drifts against the host's, and its frames have a phase of their own.
#pragma once

#include <algorithm>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// Frame k is measured at phase + k periods of the device's clock after it was switched on.
class DeviceClock {
 public:
  DeviceClock(Instant on_at, Nanos phase, double rate_hz, double drift_ppm) noexcept
      : first_(on_at + phase), period_s_(1.0 / (rate_hz * (1.0 + drift_ppm * 1e-6))) {}

  Instant measured_at(std::uint32_t frame) const noexcept {
    return first_ + from_seconds(static_cast<double>(frame) * period_s_);
  }
  /// The newest frame whose measurement is not after `t`; 0 before the first.
  std::uint32_t newest_at(Instant t) const noexcept {
    const double periods = seconds(t - first_) / period_s_;
    auto frame = static_cast<std::uint32_t>(std::max(0.0, periods));
    // The two roundings may differ by a nanosecond; measured_at() is the one that counts.
    if (measured_at(frame + 1) <= t) ++frame;
    if (frame > 0 && measured_at(frame) > t) --frame;
    return frame;
  }

 private:
  Instant first_;
  double period_s_;
};

}  // namespace orcart
