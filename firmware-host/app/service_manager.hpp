// What the service manager (systemd) is told: one datagram each, without its library.
#pragma once

#include <string>
#include <string_view>

#include "realtime/base/instant.hpp"

namespace orcart {

/// Without a manager everything here does nothing. Any thread; never blocks.
class ServiceManager {
 public:
  ServiceManager() = default;
  /// `address`: a path, or @NAME for an abstract socket; empty: nobody. `watchdog`: 0 where it does not
  /// watch.
  ServiceManager(std::string address, Nanos watchdog) : address_(std::move(address)), watchdog_(watchdog) {}
  /// NOTIFY_SOCKET, and WATCHDOG_USEC where WATCHDOG_PID is this process or is not set: sd_notify(3),
  /// sd_watchdog_enabled(3).
  static ServiceManager from_environment();

  bool present() const noexcept { return !address_.empty(); }
  /// Without a sign of life for this long the process is killed and started again.
  Nanos watchdog() const noexcept { return watchdog_; }
  /// Lines such as "READY=1" or "WATCHDOG=1"; false where nobody took them.
  bool tell(std::string_view lines) const noexcept;

 private:
  std::string address_;
  Nanos watchdog_{};
};

}  // namespace orcart
