// A position sensor that answers as an NDI Polaris or Vega does: bytes in, bytes out, no input or output of
// its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "board/sim/ndi/command_line.hpp"
#include "board/sim/ndi/device_clock.hpp"
#include "board/sim/ndi/emulated_model.hpp"
#include "board/sim/ndi/emulated_port.hpp"
#include "board/sim/ndi/fault_schedule.hpp"
#include "board/sim/ndi/reply_queue.hpp"
#include "board/sim/ndi/self_report.hpp"
#include "board/sim/ndi/user_parameters.hpp"
#include "board/sim/ndi/wire_text.hpp"
#include "board/sim/tool_motion.hpp"
#include "realtime/base/instant.hpp"

namespace orcart {

struct NdiEmulatorSettings {
  NdiModel model = NdiModel::vega;
  double frame_rate_hz = 60;
  std::uint32_t measures_each =
      0;                          ///< of so many frames it measures one, and refuses IRATE; 0: as it is told
  double clock_drift_ppm = 0;     ///< of the device's clock against the host's
  Nanos frame_phase = 3ms;        ///< first frame after switching on
  Nanos device_latency = 4ms;     ///< from a frame's measurement to the first reply that can carry it
  Nanos processing_time = 300us;  ///< from a command's last byte to the reply's first
  Nanos reset_time = 400ms;       ///< from a break to RESET
  bool has_line = true;           ///< false: a network device, whose bytes take no time
  std::size_t packet_bytes = 62;  ///< the host gets bytes in packets of this size
  MarkerNoise noise;
  Instant on_at = instant_from_nanos(0);  ///< when the device was switched on
};

/// One thread. Allocates nothing after construction. Tool n of `motion` is the n-th port handle.
class NdiEmulator {
 public:
  static constexpr std::size_t kMaxPorts = 16;

  NdiEmulator(const NdiEmulatorSettings& settings, const ToolMotion& motion);

  /// Puts a tool into a port, as a wired one is: after INIT it has a handle that is not initialised yet. At
  /// most 4; false where there are more, or the definition is too long.
  bool plug_in(std::span<const std::byte> definition) noexcept;

  /// Bytes that the host hands over at `now`; they take their time over the line.
  void receive(std::span<const std::byte> bytes, Instant now) noexcept;
  /// What arrives while host and device use different line rates: the device can make nothing of it.
  void receive_noise() noexcept { line_size_ = 0; }
  /// Another host has taken the line: what the one before began to say, and has not read, is none of its
  /// business.
  void change_host(Instant now) noexcept;
  /// A serial break, or power switched off and on.
  void receive_break(Instant now) noexcept;
  /// Takes the reply bytes that have arrived at the host by `now`.
  std::size_t read(std::span<std::byte> into, Instant now) noexcept;
  void discard(Instant now) noexcept;

  /// When the next reply byte arrives, or the next reset is due; Instant::max() where neither will.
  Instant next_event() const noexcept;
  /// Whether bytes of a reply are still on their way.
  bool owes_a_reply() const noexcept { return replies_.next_arrival() != Instant::max(); }
  Instant last_arrival() const noexcept { return replies_.last_taken(); }
  /// The line rate in use at `now`: after COMM the device answers first and then changes it.
  std::uint32_t baud(Instant now) const noexcept { return now < switch_at_ ? baud_ : next_baud_; }
  bool tracking() const noexcept { return tracking_; }
  const DeviceClock& device_clock() const noexcept { return clock_; }
  NdiFaultSchedule& faults() noexcept { return faults_; }
  std::uint64_t replies_sent() const noexcept { return replies_sent_; }
  std::uint64_t beeps_heard() const noexcept { return beeps_heard_; }

 private:
  /// What a handler may need to know about the moment.
  struct Moment {
    Instant now{};            ///< the command is complete
    std::uint32_t frame = 0;  ///< the newest that a reply can carry
  };
  enum class Mode : std::uint8_t { any, set_up, not_tracking, tracking_only };
  using Handler = NdiError (NdiEmulator::*)(std::string_view arguments, const Moment& moment) noexcept;
  struct Verb {
    std::string_view name;
    Mode mode;
    Handler handler;
  };
  struct ToolReading {
    std::uint8_t handle = 0;
    bool disabled = false;
    bool missing = false;
    MarkerFit fit;
    std::uint32_t status = 0;
  };
  static std::span<const Verb> verbs() noexcept;

  void obey(std::string_view line, Instant complete_at) noexcept;
  NdiError dispatch(const CommandLine& command, const Moment& moment) noexcept;
  NdiError objection_to(Mode mode) const noexcept;
  void send(Instant now) noexcept;
  void damage(std::span<std::byte> bytes, Instant now) noexcept;
  void catch_up(Instant now) noexcept;
  void restart(Instant now) noexcept;
  /// Frames are numbered anew, as if they had come at that rate since the device was switched on.
  void run_frames_at(double rate_hz) noexcept;
  Nanos byte_time() const noexcept;
  NdiError okay() noexcept;

  // emulator_system.cpp
  NdiError on_init(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_comm(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_ver(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_apirev(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_sflist(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_sstat(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_get(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_getinfo(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_set(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_beep(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_irate(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_irchk(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_echo(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_reset(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_accepted(std::string_view arguments, const Moment& moment) noexcept;

  // emulator_ports.cpp
  NdiError on_phrq(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_pvwr(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_phsr(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_phinf(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_pinit(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_pena(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_pdis(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_phf(std::string_view arguments, const Moment& moment) noexcept;
  EmulatedPort* port_of(std::string_view handle) noexcept;
  void suffer_tool_faults(Instant now) noexcept;

  // emulator_tracking.cpp
  NdiError on_tstart(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_tstop(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_tx(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_bx(std::string_view arguments, const Moment& moment) noexcept;
  NdiError on_bx2(std::string_view arguments, const Moment& moment) noexcept;
  std::uint32_t reported_ports() const noexcept;
  ToolReading reading_of(std::size_t port, const Moment& moment) const noexcept;
  std::uint32_t frame_number(std::uint32_t frame) const noexcept { return frame - frame_zero_; }
  std::uint16_t system_status(Instant now) const noexcept;
  void refresh_parameters() noexcept;
  void put_alerts() noexcept;
  Moment moment_at(Instant now) const noexcept;
  void put_tx_tool(const ToolReading& tool, std::size_t port, std::uint16_t options,
                   const Moment& moment) noexcept;
  void put_bx_tool(const ToolReading& tool, std::size_t port, std::uint16_t options,
                   const Moment& moment) noexcept;
  void put_six_d(const Moment& moment) noexcept;
  void put_three_d(const Moment& moment) noexcept;

  NdiEmulatorSettings settings_;
  const ToolMotion& motion_;
  double frame_rate_hz_;  ///< now; a host may have set another than it was switched on with
  DeviceClock clock_;
  NdiFaultSchedule faults_;
  std::array<EmulatedPort, kMaxPorts> ports_;
  std::array<EmulatedPort, 4> plugged_in_;
  const EmulatedModel& model_;
  UserParameters parameters_;
  SelfReport self_report_;
  std::uint16_t port_events_ = 0;  ///< of system status: a port became occupied or unoccupied; until asked
  ReplyQueue replies_;
  WireText reply_;
  bool binary_reply_ = false;

  std::array<char, 2048> line_{};
  std::size_t line_size_ = 0;
  bool line_too_long_ = false;

  std::uint32_t baud_ = 9600;
  std::uint32_t next_baud_ = 9600;  ///< from `switch_at_` on
  Instant switch_at_{};
  Instant deaf_until_{};  ///< restarting
  bool initialised_ = false;
  bool tracking_ = false;
  Instant tracking_since_{};
  std::uint32_t frame_zero_ = 0;
  std::uint32_t last_bx2_frame_ = 0;
  std::uint64_t replies_sent_ = 0;
  std::uint64_t beeps_heard_ = 0;
  Instant beeping_until_{};
};

}  // namespace orcart
