// Which USB device is the tracker: the ids that are known, and the choice by serial number or port path.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "realtime/base/result.hpp"

namespace orcart {

/// One device on the bus, as far as it can be told without opening it for good.
struct UsbDeviceId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t bcd_device = 0;
  std::string port_path;  ///< as the kernel names it: 1-2.3 is bus 1, port 2, port 3 of the hub there
  std::string serial;     ///< empty where it has none, or may not be read
};

/// "NDI Host USB Converter", "FTDI FT232", ...; empty for what is neither NDI's nor a plain FTDI bridge.
std::string_view usb_name_of(std::uint16_t vendor, std::uint16_t product) noexcept;
/// Made for a tracker, so that it may be opened without being named.
bool is_ndi(std::uint16_t vendor, std::uint16_t product) noexcept;

/// NDI's ids take 19200 baud for 1.2 Mbaud, as the Linux driver ftdi_sio does: programs that know only the
/// usual rates so reach the fastest. Other devices and rates stay as they are.
std::uint32_t line_rate_for(std::uint16_t vendor, std::uint16_t product, std::uint32_t baud) noexcept;

/// Empty fields choose nothing.
struct UsbChoice {
  std::string serial;
  std::string port_path;
};

/// The one that matches. Without a choice: the only device of NDI's; a plain FTDI bridge may be anything and
/// has to be named. Refused in a sentence that lists what is there.
Result<UsbDeviceId> choose_tracker(std::span<const UsbDeviceId> devices, const UsbChoice& choice);

/// "0403:DA70 NDI Host USB Converter at port 1-2, serial number P6-00123".
std::string description_of(const UsbDeviceId& device);

}  // namespace orcart
