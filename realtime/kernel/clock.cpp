// The host's monotonic clock, read and slept on through the system calls that cannot drift.
#include "realtime/kernel/clock.hpp"

#include <cerrno>
#include <ctime>

namespace orcart {

Instant RealClock::now() const noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return instant_from_nanos(std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec);
}

void RealClock::sleep_until(Instant deadline) noexcept {
  const std::int64_t ns = nanos_since_zero(deadline);
  if (ns <= 0) return;
  const timespec t{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
    // A signal cut the sleep short; the deadline is absolute, so it is simply asked for again.
  }
}

}  // namespace orcart
