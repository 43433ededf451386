// One port handle of the emulated tracker: its tool memory, what was read from it, and its life cycle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "board/sim/ndi/marker_fit.hpp"

namespace orcart {

/// NDI's error codes, as far as the emulator gives them.
enum class NdiError : std::uint8_t {
  none = 0,
  invalid_command = 0x01,
  too_long = 0x02,
  too_short = 0x03,
  bad_crc = 0x04,
  line_setting = 0x06,
  wrong_parameters = 0x07,
  no_such_handle = 0x08,
  no_such_priority = 0x09,
  wrong_mode = 0x0C,
  no_tool = 0x0D,
  not_initialised_port = 0x0E,
  not_initialised_system = 0x10,
  out_of_range = 0x23,
  handles_full = 0x2D,
  no_such_parameter = 0x34,
  wrong_value_type = 0x35,
  value_out_of_range = 0x36,
  read_only = 0x39,
  damaged_definition = 0x40,
  unsupported_tool = 0x41,
};

class EmulatedPort {
 public:
  static constexpr std::size_t kMemoryBytes = 1024;

  bool allocated() const noexcept { return allocated_; }
  bool occupied() const noexcept { return occupied_; }
  bool initialised() const noexcept { return initialised_; }
  bool enabled() const noexcept { return enabled_; }
  /// Enabled by the host and not disabled by it since: TX and BX speak of it, if only to say DISABLED.
  bool reported() const noexcept { return reported_; }

  void allocate() noexcept;
  /// A tool with a plug, in the socket of that number (from 1); 0 for a wireless one.
  void plug_into(int socket) noexcept { socket_ = socket; }
  int socket() const noexcept { return socket_; }
  void release() noexcept { *this = EmulatedPort{}; }
  /// Refused outside the memory.
  NdiError write(std::size_t address, std::span<const std::byte> bytes) noexcept;
  /// Reads the definition; refused where its checksum or its number of markers is wrong.
  NdiError initialise() noexcept;
  /// A port that holds a tool is initialised by the way.
  NdiError enable(char priority) noexcept;
  NdiError disable() noexcept;
  /// What may happen to a tool behind the host's back.
  void lose_enable() noexcept { enabled_ = false; }
  void unplug() noexcept { occupied_ = initialised_ = enabled_ = false; }

  /// Bits as port status has them: 01 in port, 10 initialised, 20 enabled.
  std::uint32_t status() const noexcept;
  std::span<const Eigen::Vector3d> markers_mm() const noexcept { return {markers_mm_.data(), marker_count_}; }

  std::uint8_t byte_at(std::size_t address) const noexcept {
    return std::to_integer<std::uint8_t>(memory_[address]);
  }
  std::uint32_t number_at(std::size_t address) const noexcept;
  /// Up to the first zero.
  std::string_view text_at(std::size_t address, std::size_t size) const noexcept;

 private:
  bool checksum_holds() const noexcept;

  std::array<std::byte, kMemoryBytes> memory_{};
  std::array<Eigen::Vector3d, kMaxToolMarkers> markers_mm_;
  std::size_t marker_count_ = 0;
  int socket_ = 0;
  bool allocated_ = false;
  bool occupied_ = false;
  bool initialised_ = false;
  bool enabled_ = false;
  bool reported_ = false;
};

}  // namespace orcart
