// When the emulated tracker misbehaves, and how: windows of time, each with one fault.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "realtime/base/instant.hpp"

namespace orcart {

enum class NdiFault : std::uint8_t {
  silence,       ///< no reply at all
  late,          ///< replies come `amount` milliseconds late
  truncated,     ///< replies end after `amount` bytes
  garbage,       ///< replies are noise of the same length
  bad_crc,       ///< one bit of the reply is wrong
  wrong_handle,  ///< BX and TX speak of handles that nobody has
  frozen_frame,  ///< the frame number stands still, and the poses with it
  infrared,      ///< system status: too much environmental infra-red
  disabled,      ///< the tool of index `amount` is no longer enabled
  unplugged,     ///< the tool of index `amount` is no longer in its port
  reset,         ///< the device restarts once, at the beginning of the window
  bump,          ///< the sensor is knocked once, at the beginning of the window
  alert,         ///< the alert of bit `amount` is raised once, at the beginning of the window
  cut,           ///< the cable is out: served ports close and open again
};

/// The word for it on a command line; nothing where there is no such fault.
std::optional<NdiFault> ndi_fault_named(std::string_view name) noexcept;

struct NdiFaultWindow {
  NdiFault fault = NdiFault::silence;
  Instant from{};
  Instant until = Instant::max();
  std::int64_t amount = 0;
  std::uint32_t every = 1;  ///< only each `every`-th reply, counted from the device's start
};

/// A small fixed table; one thread.
class NdiFaultSchedule {
 public:
  static constexpr std::size_t kMax = 32;

  /// False where the table is full.
  bool add(const NdiFaultWindow& window) noexcept;
  void clear() noexcept { count_ = 0; }
  /// The window of that fault which is open at `now` and hits the `reply`-th reply; null where none is.
  const NdiFaultWindow* active(NdiFault fault, Instant now, std::uint64_t reply) const noexcept;
  /// Whether a window of that fault for the tool `amount` is open at `now`.
  bool hits_tool(NdiFault fault, Instant now, std::int64_t tool) const noexcept;
  /// Takes the fault that is due at `now` off the table, so that each happens once.
  std::optional<NdiFaultWindow> take_due(NdiFault fault, Instant now) noexcept;
  /// When the next reset is due; Instant::max() where none is.
  Instant next_reset() const noexcept;

 private:
  std::array<NdiFaultWindow, kMax> windows_{};
  std::size_t count_ = 0;
};

}  // namespace orcart
