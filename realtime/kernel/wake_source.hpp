// What a thread may sleep on: input from a device, bounded by a deadline.
#pragma once

#include "realtime/base/instant.hpp"

namespace orcart {

class WakeSource {
 public:
  virtual ~WakeSource() = default;
  /// Blocks the calling thread until there is input (or a fault to be read) or the deadline has come.
  virtual void wait(Instant deadline) noexcept = 0;
  /// Simulated sources: the instant at which wait() would return because of input, so that a simulated clock
  /// can be moved there. Real ones cannot know: Instant::max().
  virtual Instant next_event() const noexcept { return Instant::max(); }
};

}  // namespace orcart
