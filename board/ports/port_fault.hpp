// What can go wrong at a port, as a code that costs nothing to pass on.
#pragma once

#include <string_view>

namespace orcart {

enum class PortFault {
  nothing_yet,   ///< no input has arrived; not an error
  timed_out,     ///< the deadline passed before the bytes were out
  disconnected,  ///< the device is gone; only a re-open helps
  busy,          ///< somebody else holds the device
  no_permission,
  io,           ///< the driver reports a failed transfer
  damaged,      ///< this one item is bad (error buffer, lost edge); the next may be good
  unsupported,  ///< the device cannot do what was asked
};

constexpr std::string_view word_for(PortFault fault) {
  switch (fault) {
    case PortFault::nothing_yet:
      return "nothing yet";
    case PortFault::timed_out:
      return "timed out";
    case PortFault::disconnected:
      return "disconnected";
    case PortFault::busy:
      return "in use by another program";
    case PortFault::no_permission:
      return "no permission";
    case PortFault::io:
      return "transfer failed";
    case PortFault::damaged:
      return "damaged item";
    case PortFault::unsupported:
      return "not supported";
  }
  return "unknown fault";
}

}  // namespace orcart
