// What every stage of the way of the data is: a step that is told the time, does bounded work and says what
// it did.
#pragma once

#include <cstdint>
#include <string_view>

#include "realtime/base/instant.hpp"

namespace orcart {

struct StepReport {
  bool worked = false;      ///< false: there was nothing to do, and the step is no sample for its histogram
  bool carried = false;     ///< the cap was reached; the rest goes on in the next step
  std::uint32_t items = 0;  ///< what was handled, in the stage's own unit (frames, replies, triangles, ...)
};

/// A stage owns no thread and no file descriptor: the same object runs on the wall clock, on a simulated
/// clock and from a recording. One thread calls step(), always the same one after arming.
class Stage {
 public:
  virtual ~Stage() = default;
  virtual std::string_view name() const noexcept = 0;
  /// On the thread that will step, before the first step and after the last: for what belongs to a thread,
  /// such as a GL context. A SimulatedRunner calls neither: all its stages live on the caller's thread.
  virtual void enter_thread() noexcept {}
  virtual void leave_thread() noexcept {}
  /// Does what is due at `now`. Allocates nothing, locks nothing, waits for nothing.
  virtual StepReport step(Instant now) noexcept = 0;
};

}  // namespace orcart
