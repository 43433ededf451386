// What NDI's numbers mean, in words for a person: error replies, port status, system status.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace orcart::ndi {

/// Port status.
inline constexpr std::uint32_t kToolInPort = 0x01;
inline constexpr std::uint32_t kSwitch1 = 0x02;
inline constexpr std::uint32_t kSwitch2 = 0x04;
inline constexpr std::uint32_t kSwitch3 = 0x08;
inline constexpr std::uint32_t kPortInitialised = 0x10;
inline constexpr std::uint32_t kPortEnabled = 0x20;
inline constexpr std::uint32_t kOutOfVolume = 0x40;
inline constexpr std::uint32_t kPartlyInVolume = 0x80;
inline constexpr std::uint32_t kSensorBroken = 0x0100;  ///< Aurora; on a Polaris a limit of the algorithm
inline constexpr std::uint32_t kInterference = 0x0200;  ///< infra-red light, or metal in the field
inline constexpr std::uint32_t kSignalTooSmall = 0x0400;
inline constexpr std::uint32_t kSignalTooBig = 0x0800;
inline constexpr std::uint32_t kProcessingException = 0x1000;
inline constexpr std::uint32_t kPortHardwareFailure = 0x2000;
inline constexpr std::uint32_t kPortReady = kToolInPort | kPortInitialised | kPortEnabled;

/// System status.
inline constexpr std::uint16_t kTooMuchInfrared = 0x0002;
inline constexpr std::uint16_t kPortOccupied = 0x0040;
inline constexpr std::uint16_t kPortUnoccupied = 0x0080;
inline constexpr std::uint16_t kAlertsPending =
    0x0100;  ///< the device has something to say: ask for its alerts

/// A tool's code in BX2.
inline constexpr std::uint8_t kToolPartlyInView = 3;
inline constexpr std::uint8_t kToolOutOfVolume = 9;
inline constexpr std::uint8_t kToolMissing = 31;
inline constexpr std::uint8_t kTrackingNotEnabled = 32;
inline constexpr std::uint8_t kToolUnplugged = 33;

/// The code of an ERRORhh reply; nothing where the text is none.
std::optional<std::uint8_t> error_code(std::string_view reply) noexcept;

/// What an error code says; never empty.
std::string_view error_word(std::uint8_t code) noexcept;

/// Why a port cannot be tracked, most basic reason first; "ready" where it can.
std::string_view disabled_reason(std::uint32_t port_status) noexcept;

/// All that a port's status says beside "ready", separated by commas; "ready" where it says nothing else.
/// Allocates.
std::string port_status_words(std::uint32_t port_status);

/// What a tool's code in BX2 says; never empty.
std::string_view tool_status_word(std::uint8_t code) noexcept;

/// All that is wrong, separated by commas; "fine" for 0. Allocates: not for a step().
std::string system_status_words(std::uint16_t status);

}  // namespace orcart::ndi
