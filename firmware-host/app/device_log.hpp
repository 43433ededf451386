// Says once that a device is gone, and once that it is back; likewise of a session that is not kept.
#pragma once

#include <array>
#include <string>

#include "firmware-host/app/cart.hpp"

namespace orcart {

class DeviceLog {
 public:
  /// A line for each device whose state differs from the last call's; empty where none does.
  std::string news(const Cart::Now& now);

 private:
  std::string session_news(const Cart::Now& now);
  std::string tracker_news(const Cart::Now& now);

  int mismatch_deg_ = 0;
  std::string tracker_, tracker_remark_;
  bool session_failing_ = false, told_loss_ = false;
  std::array<PortFault, 4> known_{PortFault::nothing_yet, PortFault::nothing_yet, PortFault::nothing_yet,
                                  PortFault::nothing_yet};
};

}  // namespace orcart
