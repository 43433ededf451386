// The turn encoder's seam: stamped counts of what goes round with a scope's light post.
#pragma once

#include <cstdint>

#include "board/ports/port_fault.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Where the encoder has come to. It stands there until the next reading.
struct EncoderReading {
  Instant at{};  ///< the kernel's stamp; of a run's first reading: when it began
  std::int64_t counts = 0;
  /// Counts of one run belong together. Another one: the device was opened anew, or steps were lost.
  std::uint32_t run = 0;
};

/// One thread calls; nothing here waits.
class TurnEncoder {
 public:
  virtual ~TurnEncoder() = default;
  /// The oldest reading not yet taken. A run begins with one, however still the encoder stands; from then on
  /// there is one for each step. nothing_yet where there is none; disconnected while the device is gone:
  /// calling on opens it again.
  virtual Result<EncoderReading, PortFault> take_reading() noexcept = 0;
};

}  // namespace orcart
