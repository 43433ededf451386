// Where time comes from: the host's monotonic clock on a cart, a clock that is set by hand in tests and
// simulation.
#pragma once

#include "realtime/base/instant.hpp"

namespace orcart {

class Clock {
 public:
  virtual ~Clock() = default;
  /// Any thread; never blocks.
  virtual Instant now() const noexcept = 0;
  /// Blocks the calling thread until `deadline` (absolute, so that a late wake-up does not shift the next
  /// one).
  virtual void sleep_until(Instant deadline) noexcept = 0;
};

/// CLOCK_MONOTONIC; sleeps by clock_nanosleep(TIMER_ABSTIME).
class RealClock final : public Clock {
 public:
  Instant now() const noexcept override;
  void sleep_until(Instant deadline) noexcept override;
};

/// Time that stands still until it is moved. One thread; sleep_until moves it.
class SimulatedClock final : public Clock {
 public:
  explicit SimulatedClock(Instant start = instant_from_nanos(1'000'000'000)) : now_(start) {}
  Instant now() const noexcept override { return now_; }
  void sleep_until(Instant deadline) noexcept override { advance_to(deadline); }
  void advance_to(Instant t) noexcept { now_ = t > now_ ? t : now_; }
  void advance_by(Nanos d) noexcept { now_ += d; }

 private:
  Instant now_;
};

}  // namespace orcart
