// The two words for time: an Instant on CLOCK_MONOTONIC and a length of time in nanoseconds.
#pragma once

#include <chrono>
#include <cstdint>

namespace orcart {

/// A length of time. The literals of std::chrono convert to it: `Nanos budget = 2ms;`.
using Nanos = std::chrono::duration<std::int64_t, std::nano>;

/// Names the host's CLOCK_MONOTONIC in types; reading it is the business of Clock
/// (realtime/kernel/clock.hpp).
struct Monotonic {
  using duration = Nanos;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<Monotonic>;
  static constexpr bool is_steady = true;
};

/// A point in time on CLOCK_MONOTONIC.
using Instant = Monotonic::time_point;

using namespace std::chrono_literals;

/// The whole number of nanoseconds since the clock's zero.
constexpr std::int64_t nanos_since_zero(Instant t) {
  return t.time_since_epoch().count();
}
constexpr Instant instant_from_nanos(std::int64_t ns) {
  return Instant{Nanos{ns}};
}

/// Lengths of time as numbers, for printing and arithmetic.
constexpr double seconds(Nanos d) {
  return static_cast<double>(d.count()) * 1e-9;
}
constexpr double milliseconds(Nanos d) {
  return static_cast<double>(d.count()) * 1e-6;
}
constexpr double microseconds(Nanos d) {
  return static_cast<double>(d.count()) * 1e-3;
}

/// The length of time nearest to a number of seconds.
constexpr Nanos from_seconds(double s) {
  return Nanos{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}

/// The period of a rate in hertz, rounded to the nanosecond.
constexpr Nanos period_of(double rate_hz) {
  return from_seconds(1.0 / rate_hz);
}

}  // namespace orcart
