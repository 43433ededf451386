// The table of ids and the choice.
#include "board/linux/usb/usb_choice.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace orcart {
namespace {

constexpr std::uint16_t kFtdiVendor = 0x0403;
constexpr std::uint16_t kNdiVendor = 0x23F2;
constexpr std::uint16_t kFirstNdiBridge = 0x0003;  // 0001 and 0002 are no serial bridges

struct KnownId {
  std::uint16_t product;
  std::string_view name;
};
constexpr std::array<KnownId, 5> kNdiOfFtdi{{{0xDA70, "NDI Host USB Converter"},
                                             {0xDA71, "NDI Spectra SCU"},
                                             {0xDA72, "NDI tracker"},
                                             {0xDA73, "NDI tracker"},
                                             {0xDA74, "NDI Aurora SCU"}}};
constexpr std::array<KnownId, 5> kPlain{{{0x6001, "FTDI FT232"},
                                         {0x6010, "FTDI FT2232"},
                                         {0x6011, "FTDI FT4232"},
                                         {0x6014, "FTDI FT232H"},
                                         {0x6015, "FTDI FT-X"}}};

std::string_view name_in(std::span<const KnownId> table, std::uint16_t product) noexcept {
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const KnownId& known) { return known.product == product; });
  return row == table.end() ? std::string_view{} : row->name;
}

bool matches(const UsbDeviceId& device, const UsbChoice& choice) {
  if (!choice.serial.empty() && device.serial != choice.serial) return false;
  if (!choice.port_path.empty() && device.port_path != choice.port_path) return false;
  const bool named = !choice.serial.empty() || !choice.port_path.empty();
  return named || is_ndi(device.vendor, device.product);
}

std::string wanted(const UsbChoice& choice) {
  std::string text;
  if (!choice.serial.empty()) text += " with the serial number " + choice.serial;
  if (!choice.port_path.empty()) text += " at port " + choice.port_path;
  return text.empty() ? " of NDI's" : text;
}

std::string list_of(std::span<const UsbDeviceId> devices) {
  if (devices.empty()) return "no NDI or FTDI device is plugged in";
  std::string list = "there is ";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (i > 0) list += "; ";
    list += description_of(devices[i]);
  }
  return list;
}

}  // namespace

std::string_view usb_name_of(std::uint16_t vendor, std::uint16_t product) noexcept {
  if (vendor == kNdiVendor && product >= kFirstNdiBridge) return "NDI tracker";
  if (vendor != kFtdiVendor) return {};
  const std::string_view ndi = name_in(kNdiOfFtdi, product);
  return ndi.empty() ? name_in(kPlain, product) : ndi;
}

bool is_ndi(std::uint16_t vendor, std::uint16_t product) noexcept {
  return usb_name_of(vendor, product).starts_with("NDI");
}

std::uint32_t line_rate_for(std::uint16_t vendor, std::uint16_t product, std::uint32_t baud) noexcept {
  return baud == 19'200 && is_ndi(vendor, product) ? 1'200'000 : baud;
}

std::string description_of(const UsbDeviceId& device) {
  std::array<char, 16> ids{};
  std::snprintf(ids.data(), ids.size(), "%04X:%04X ", unsigned{device.vendor}, unsigned{device.product});
  std::string text =
      ids.data() + std::string(usb_name_of(device.vendor, device.product)) + " at port " + device.port_path;
  return text + (device.serial.empty() ? ", serial number not readable" : ", serial number " + device.serial);
}

Result<UsbDeviceId> choose_tracker(std::span<const UsbDeviceId> devices, const UsbChoice& choice) {
  const UsbDeviceId* chosen = nullptr;
  for (const UsbDeviceId& device : devices) {
    if (!matches(device, choice)) continue;
    if (chosen != nullptr) {
      return fail("more than one USB tracker" + wanted(choice) + " is there: " + list_of(devices) +
                  "; name one by its serial number or port");
    }
    chosen = &device;
  }
  if (chosen == nullptr) {
    return fail("no USB tracker" + wanted(choice) + ": " + list_of(devices) +
                "; plug it in, or name another by its serial number or port");
  }
  return *chosen;
}

}  // namespace orcart
