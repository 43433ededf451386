// What NDI's numbers mean, in words for a person: error replies, port status, system status.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace orcart::ndi {

/// Port status; higher bits are not documented and are passed over.
inline constexpr std::uint32_t kToolInPort = 0x01;
inline constexpr std::uint32_t kSwitch1 = 0x02;
inline constexpr std::uint32_t kSwitch2 = 0x04;
inline constexpr std::uint32_t kSwitch3 = 0x08;
inline constexpr std::uint32_t kPortInitialised = 0x10;
inline constexpr std::uint32_t kPortEnabled = 0x20;
inline constexpr std::uint32_t kOutOfVolume = 0x40;
inline constexpr std::uint32_t kPartlyInVolume = 0x80;
inline constexpr std::uint32_t kPortReady = kToolInPort | kPortInitialised | kPortEnabled;

/// System status.
inline constexpr std::uint16_t kTooMuchInfrared = 0x0002;

/// The code of an ERRORhh reply; nothing where the text is none.
std::optional<std::uint8_t> error_code(std::string_view reply) noexcept;

/// What an error code says; never empty.
std::string_view error_word(std::uint8_t code) noexcept;

/// Why a port cannot be tracked, most basic reason first; "ready" where it can.
std::string_view disabled_reason(std::uint32_t port_status) noexcept;

/// All that is wrong, separated by commas; "fine" for 0. Allocates: not for a step().
std::string system_status_words(std::uint16_t status);

}  // namespace orcart::ndi
