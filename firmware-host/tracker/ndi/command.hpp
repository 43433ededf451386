// One NDI command as it goes over the wire: name, arguments, CRC and carriage return in a buffer of fixed
// size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace orcart::ndi {

enum class ReplyKind : std::uint8_t { ascii, binary };

/// Which handles PHSR lists.
enum class PortSearch : std::uint8_t {
  all = 0,
  to_free = 1,
  uninitialised = 2,
  not_enabled = 3,
  enabled = 4
};

/// How PENA asks for a tool to be tracked: it stands still, it moves, or it only has buttons.
enum class TrackingPriority : char { still = 'S', moving = 'D', buttons = 'B' };

/// Options of TX and BX; they add up.
inline constexpr std::uint16_t kTransforms = 0x0001;
inline constexpr std::uint16_t kToolInformation = 0x0002;
inline constexpr std::uint16_t kSingleStray = 0x0004;
inline constexpr std::uint16_t kMarkerPositions = 0x0008;
inline constexpr std::uint16_t kOutOfVolumeToo = 0x0800;
inline constexpr std::uint16_t kPassiveStrays = 0x1000;

/// Options of PHINF; they add up.
inline constexpr std::uint16_t kPortBasics = 0x0001;
inline constexpr std::uint16_t kPartNumber = 0x0004;
inline constexpr std::uint16_t kPortLocation = 0x0020;

/// A tool definition is uploaded in blocks of this size into a memory of kRomMemoryBytes.
inline constexpr std::size_t kRomBlockBytes = 64;
inline constexpr std::size_t kRomMemoryBytes = 1024;

/// Formatting never allocates; arguments that do not fit leave the command empty.
class Command {
 public:
  static constexpr std::size_t kCapacity = 160;

  Command() = default;
  Command(std::string_view name, std::string_view arguments, ReplyKind kind = ReplyKind::ascii) noexcept;

  std::span<const std::byte> bytes() const noexcept {
    return std::as_bytes(std::span<const char>{text_.data(), size_});
  }
  std::string_view text() const noexcept { return {text_.data(), size_}; }
  /// The word in front of the colon.
  std::string_view name() const noexcept { return {text_.data(), name_size_}; }
  ReplyKind reply_kind() const noexcept { return kind_; }

 private:
  std::array<char, kCapacity> text_{};
  std::size_t size_ = 0;
  std::size_t name_size_ = 0;
  ReplyKind kind_ = ReplyKind::ascii;
};

Command initialise() noexcept;
/// 8 data bits, no parity, one stop bit. `code` as in kBaudCodes.
Command set_line(char code, bool hardware_flow) noexcept;
Command request_wireless_handle() noexcept;
/// One block of a tool definition; `block` counts from 0.
Command write_rom(std::uint8_t handle, std::size_t block,
                  std::span<const std::byte, kRomBlockBytes> bytes) noexcept;
Command search_ports(PortSearch which) noexcept;
Command initialise_port(std::uint8_t handle) noexcept;
Command enable_port(std::uint8_t handle, TrackingPriority priority) noexcept;
Command free_port(std::uint8_t handle) noexcept;
Command describe_port(std::uint8_t handle, std::uint16_t options) noexcept;
Command start_tracking() noexcept;
Command stop_tracking() noexcept;
Command poll_text(std::uint16_t options) noexcept;
Command poll_binary(std::uint16_t options) noexcept;
/// BX2 with the tools' poses and alerts alone.
Command poll_frames() noexcept;
/// 1 to 9 times; allowed while tracking. The reply is 0 while it still beeps.
Command beep(int times) noexcept;
Command ask_api_revision() noexcept;
/// VER, for devices that know no parameters.
Command ask_version() noexcept;
Command get_parameter(std::string_view name) noexcept;
Command set_parameter(std::string_view name, std::uint32_t value) noexcept;
/// The rate of the oldest devices: 0 is 20 Hz, 1 is 30 Hz, 2 is 60 Hz.
Command set_illuminator_rate(int code) noexcept;

}  // namespace orcart::ndi
