// [tracker] of cart.toml: which tracker, how it is reached, and which tools it follows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "board/ports/byte_link.hpp"
#include "firmware-host/files/toml_reader.hpp"
#include "firmware-host/stages/assumed_errors.hpp"
#include "firmware-host/tracker/ndi_settings.hpp"

namespace orcart {

/// How the tracker is reached; the simulated one is made together with the rest of the simulated cart.
enum class TrackerKind : std::uint8_t { simulated, usb, tty, tcp, replay };

/// Whether what it measures is there now: else every view wears the mark.
constexpr bool is_device(TrackerKind kind) noexcept {
  switch (kind) {
    case TrackerKind::usb:
    case TrackerKind::tty:
    case TrackerKind::tcp:
      return true;
    case TrackerKind::simulated:
    case TrackerKind::replay:
      break;
  }
  return false;
}

struct TrackerConfig {
  TrackerKind kind = TrackerKind::simulated;
  double rate_hz = 60;
  std::uint32_t baud = 115200;  ///< the fastest to try; 0 over TCP, which has no line
  FlowControl flow = FlowControl::none;
  double latency_ms = 0;  ///< from the device frame to its reply being ready, taken off every stamp
  std::filesystem::path scope_rom, reference_rom;  ///< empty for a wired tool
  TrackedTool::Port scope_port, reference_port;    ///< where the wired one is plugged in
  /// The marker on the other side of a turning scope's coupler, where there is one.
  bool second = false;
  std::filesystem::path second_rom;
  TrackedTool::Port second_port;
  PollForm poll = PollForm::automatic;
  int beeps = 0;  ///< when all tools are tracked
  double marker_rms_mm =
      kAssumedErrors.marker_rms_mm;  ///< of one marker's 3-D error, for the predicted error
  double max_error_mm = 0;           ///< a fit worse than this is doubtful; 0: the device's own limit will do

  std::string usb_serial;          ///< usb: empty where the only one of NDI's will do
  std::string usb_port;            ///< usb: such as 1-2.3
  std::filesystem::path device;    ///< tty: such as /dev/ttyUSB0
  std::string host;                ///< tcp: a name or an IPv4 address
  std::uint16_t port = 8765;       ///< tcp
  std::filesystem::path dialogue;  ///< replay: a recorded conversation
};

/// Keys of another kind than the stated one are unknown keys. Errors stay in the section's reader.
void read_tracker(const TomlSection& section, TrackerConfig& tracker);

/// What the driver is to be told: tool definitions read and checked; tool 0 is the scope, tool 1 the
/// reference, tool 2 the second marker where there is one.
Result<NdiSettings> settings_of(const TrackerConfig& tracker);

}  // namespace orcart
