// The tables of what NDI's numbers mean.
#include "firmware-host/tracker/ndi/words.hpp"

#include <array>
#include <utility>

#include "firmware-host/tracker/ndi/hex.hpp"

namespace orcart::ndi {
namespace {

using ErrorRow = std::pair<std::uint8_t, std::string_view>;
constexpr auto kErrors = std::to_array<ErrorRow>({
    {0x01, "invalid command"},
    {0x02, "command too long"},
    {0x03, "command too short"},
    {0x04, "the command's CRC is wrong"},
    {0x05, "time-out while obeying the command"},
    {0x06, "the line cannot be set so"},
    {0x07, "wrong number of parameters"},
    {0x08, "no such port handle"},
    {0x09, "no such tracking priority"},
    {0x0A, "no such LED"},
    {0x0B, "no such LED state"},
    {0x0C, "not allowed in this mode"},
    {0x0D, "no tool is assigned to the port handle"},
    {0x0E, "the port handle is not initialised"},
    {0x0F, "the port handle is not enabled"},
    {0x10, "the system is not initialised"},
    {0x11, "tracking cannot be stopped"},
    {0x12, "tracking cannot be started"},
    {0x13, "the tool cannot be initialised"},
    {0x14, "the sensor's characterisation is invalid"},
    {0x15, "the measurement system cannot be initialised"},
    {0x16, "diagnostic mode cannot be started"},
    {0x17, "diagnostic mode cannot be stopped"},
    {0x18, "interference cannot be determined"},
    {0x19, "the firmware version cannot be read"},
    {0x1A, "internal error of the measurement system"},
    {0x1B, "interference diagnostics cannot be initialised"},
    {0x1C, "the markers' firing signature cannot be set"},
    {0x1D, "SROM identities cannot be searched"},
    {0x1E, "SROM data cannot be read"},
    {0x1F, "SROM data cannot be written"},
    {0x20, "the SROM cannot be selected"},
    {0x21, "the tool's current cannot be tested"},
    {0x22, "the selected volume does not suit an enabled tool's wavelength"},
    {0x23, "parameter out of range"},
    {0x24, "no camera parameters for this volume"},
    {0x25, "the supported features cannot be determined"},
    {0x28, "too many tools are enabled, or a tool is of an unsupported type"},
    {0x29, "the main processor's firmware is corrupt"},
    {0x2A, "the device is out of memory"},
    {0x2B, "the port handle has not been allocated"},
    {0x2C, "the port handle has become unoccupied"},
    {0x2D, "all port handles are in use"},
    {0x2E, "incompatible firmware versions"},
    {0x2F, "invalid port description"},
    {0x30, "the port already has a handle"},
    {0x32, "invalid operation for the device behind the port handle"},
    {0x33, "feature not available"},
    {0x34, "no such user parameter"},
    {0x35, "wrong type of value"},
    {0x36, "value out of range"},
    {0x37, "index out of range"},
    {0x38, "wrong size of value"},
    {0x39, "permission denied"},
    {0x3B, "file not found"},
    {0x40, "the tool definition is damaged"},
    {0x41, "the tool's characteristics are not supported"},
    {0x42, "the device is not present"},
    {0xF1, "too much environmental infra-red"},
});

template <class Bits>
using BitRow = std::pair<Bits, std::string_view>;

constexpr auto kSystemBits = std::to_array<BitRow<std::uint16_t>>({
    {0x0001, "communication with the sensor out of step"},
    {kTooMuchInfrared, "too much environmental infra-red"},
    {0x0004, "CRC error inside the system"},
    {0x0008, "recoverable fault"},
    {0x0010, "hardware failure"},
    {0x0020, "hardware changed"},
    {kPortOccupied, "a port became occupied"},
    {kPortUnoccupied, "a port became unoccupied"},
    {kAlertsPending, "alerts are pending"},
    {0x0200, "temperature out of range"},
});

constexpr auto kPortBits = std::to_array<BitRow<std::uint32_t>>({
    {kSwitch1, "switch 1 pressed"},
    {kSwitch2, "switch 2 pressed"},
    {kSwitch3, "switch 3 pressed"},
    {kOutOfVolume, "outside the measurement volume"},
    {kPartlyInVolume, "partly outside the measurement volume"},
    {kSensorBroken, "sensor broken, or a limit of the algorithm"},
    {kInterference, "interference by light or metal"},
    {kSignalTooSmall, "signal too small"},
    {kSignalTooBig, "signal too big"},
    {kProcessingException, "processing exception"},
    {kPortHardwareFailure, "hardware failure of the port"},
});

constexpr auto kToolCodes = std::to_array<BitRow<std::uint8_t>>({
    {0, "tracked"},
    {kToolPartlyInView, "partly outside the measurement volume"},
    {5, "averaged over fewer frames than asked for"},
    {kToolOutOfVolume, "outside the measurement volume"},
    {13, "too few markers seen"},
    {14, "interference by infra-red light"},
    {17, "the markers do not fit the tool's definition"},
    {18, "too many markers in view"},
    {19, "a limit of the algorithm"},
    {20, "the device fell behind"},
    {21, "the sensors are out of step"},
    {22, "processing exception"},
    {kToolMissing, "not seen"},
    {kTrackingNotEnabled, "tracking is not enabled for it"},
    {kToolUnplugged, "unplugged"},
});

void append(std::string& words, std::string_view word) {
  if (!words.empty()) words += ", ";
  words += word;
}

}  // namespace

std::optional<std::uint8_t> error_code(std::string_view reply) noexcept {
  constexpr std::string_view kPrefix = "ERROR";
  if (!reply.starts_with(kPrefix) || reply.size() < kPrefix.size() + 2) return std::nullopt;
  const auto code = parse_hex(reply.substr(kPrefix.size(), 2));
  return code ? std::optional{static_cast<std::uint8_t>(*code)} : std::nullopt;
}

std::string_view error_word(std::uint8_t code) noexcept {
  for (const auto& [known, word] : kErrors) {
    if (known == code) return word;
  }
  return "an error this program has no word for";
}

std::string_view disabled_reason(std::uint32_t port_status) noexcept {
  if ((port_status & kToolInPort) == 0)
    return "no tool in the port: unplugged, or its definition was not loaded";
  if ((port_status & kPortInitialised) == 0) return "the port is not initialised";
  if ((port_status & kPortEnabled) == 0) return "the port is not enabled";
  return "ready";
}

std::string port_status_words(std::uint32_t port_status) {
  std::string words;
  if ((port_status & kPortReady) != kPortReady) append(words, disabled_reason(port_status));
  for (const auto& [bit, word] : kPortBits) {
    if ((port_status & bit) != 0) append(words, word);
  }
  return words.empty() ? "ready" : words;
}

std::string_view tool_status_word(std::uint8_t code) noexcept {
  for (const auto& [known, word] : kToolCodes) {
    if (known == code) return word;
  }
  return "a state this program has no word for";
}

std::string system_status_words(std::uint16_t status) {
  std::string words;
  for (const auto& [bit, word] : kSystemBits) {
    if ((status & bit) != 0) append(words, word);
  }
  return words.empty() ? "fine" : words;
}

}  // namespace orcart::ndi
