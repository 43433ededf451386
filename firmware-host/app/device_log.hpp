// Says once that a device is gone, and once that it is back.
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
  int mismatch_deg_ = 0;
  std::array<PortFault, 4> known_{PortFault::nothing_yet, PortFault::nothing_yet, PortFault::nothing_yet,
                                  PortFault::nothing_yet};
};

}  // namespace orcart
