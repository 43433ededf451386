// Devices named by environment variables, and what a test looks at around them.
#pragma once

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>

#include "realtime/base/instant.hpp"

namespace orcart::testing {

/// What a variable says; nothing where it is not set or empty.
inline std::optional<std::string> device_named(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return std::string(value);
}

inline std::string not_set(const std::string& variable) {
  return variable + " names no device (tests/hardware/README.md)";
}

/// The descriptors this process holds.
inline std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

/// The calling thread's processor time.
inline Nanos thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return Nanos{std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec};
}

}  // namespace orcart::testing
