// When a simulated camera exposes each of its frames.
#pragma once

#include <cmath>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// Frame k is exposed for `exposure` from first + k / rate_hz on, counted from the procedure's start.
struct ExposureTiming {
  double rate_hz = 30;
  Nanos exposure = 8ms;
  Nanos first = 3'100us;  ///< the camera's own phase

  Nanos start_of(std::uint64_t frame) const {
    return first + Nanos{std::llround(static_cast<double>(frame) * 1e9 / rate_hz)};
  }
  Nanos end_of(std::uint64_t frame) const { return start_of(frame) + exposure; }
  Nanos middle_of(std::uint64_t frame) const { return start_of(frame) + exposure / 2; }
};

}  // namespace orcart
