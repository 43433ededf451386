// The real USB bus, through libusb-1.0.
#pragma once

#include "board/linux/usb/usb_bus.hpp"

namespace orcart {

/// Each look and each opened device has a libusb context of its own: a fresh one reads the bus anew, so that
/// a device which was plugged in again is found where no udev daemon runs.
class LibusbBus final : public UsbBus {
 public:
  Result<std::vector<UsbDeviceId>, PortFault> list() noexcept override;
  Result<std::unique_ptr<UsbDevice>, PortFault> open(const UsbDeviceId& device) noexcept override;
};

}  // namespace orcart
