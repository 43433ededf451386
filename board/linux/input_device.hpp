// What all input devices of the kernel (evdev) have in common: opened for this program alone, their events
// stamped on the cart's clock.
#pragma once

#include <linux/input.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "board/ports/port_fault.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Opens a node to be asked; nothing is taken over yet. The error is a negative error number.
Result<OpenDevice, int> open_input(DeviceCalls& calls, const std::string& node) noexcept;

/// Stamps on CLOCK_MONOTONIC from now on, and no event for anybody else. 0, or a negative error number.
int take_over(const OpenDevice& device) noexcept;

/// As many events as wait and fit, without waiting for more; PortFault::nothing_yet, or disconnected,
/// whatever the error.
Result<std::size_t, PortFault> read_events(const OpenDevice& device, std::span<input_event> events) noexcept;

/// When the kernel saw it.
Instant stamp_of(const input_event& event) noexcept;

/// What to do about a device that `what` ("pedal", "encoder") cannot have, as "; remedy".
std::string input_remedy(std::string_view what, PortFault fault);
/// "pedal /dev/input/event5 cannot be had: no permission; a user in the group input would be let in".
/// `error`: as the calls answer it.
std::string input_trouble(std::string_view what, const std::string& node, int error);

/// /dev/input/event0, 1 ... as they are now.
std::vector<std::string> input_nodes();
/// The device's own name; empty where it tells none.
std::string input_name(const OpenDevice& device);

}  // namespace orcart
