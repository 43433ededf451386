// From an unknown device to one that tracks: the order of commands as a state machine that touches no link.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/port_reply.hpp"
#include "firmware-host/tracker/ndi_settings.hpp"
#include "firmware-host/tracker/tracker_reply.hpp"
#include "firmware-host/tracker/trouble.hpp"
#include "realtime/base/instant.hpp"

namespace orcart {

/// What the driver is to do next.
struct StartAction {
  enum class Kind : std::uint8_t {
    send,         ///< `command`, with `time` for the reply
    set_line,     ///< to `baud`
    send_break,   ///< the device restarts
    await_reset,  ///< RESET comes by itself within `time`
    pause,        ///< for `time`
    finished,     ///< the device tracks
    failed,       ///< see trouble()
  };
  Kind kind = Kind::failed;
  ndi::Command command;
  Nanos time{};
  std::uint32_t baud = 0;
};

/// A text that needs no memory of its own; what does not fit or cannot be printed is left out.
class ShortText {
 public:
  void assign(std::string_view text) noexcept;
  std::string_view view() const noexcept { return {letters_.data(), size_}; }

 private:
  std::array<char, 48> letters_{};
  std::size_t size_ = 0;
};

/// Probe at the rate last used, then at 9600, then by a break; COMM; ask what device this is; set its rate
/// (and that every frame is reported, where another host may have said otherwise); free old handles; request,
/// upload, initialise, describe and enable each wireless tool; initialise, find and enable wired ones; start
/// tracking. Order as PLUS has it. One thread; allocates nothing.
class StartSequence {
 public:
  explicit StartSequence(const NdiSettings& settings) noexcept;

  /// Starts over.
  void begin() noexcept;
  /// What to do now; the same until one of the on_...() is called.
  StartAction action() const noexcept;
  /// The action was carried out (line set, break sent, pause over).
  void on_done() noexcept;
  void on_reply(std::string_view text) noexcept;
  /// The reply was damaged, or none came in time.
  void on_no_reply() noexcept;
  void on_line_refused() noexcept;

  /// Why the newest failed start failed; so for error_code() and failed_tool().
  TrackerTrouble trouble() const noexcept { return trouble_; }
  /// The code of the ERRORhh that ended the start; 0 where none did.
  std::uint8_t error_code() const noexcept { return error_code_; }
  /// The tool that the start was busy with when it failed; -1 where with none.
  int failed_tool() const noexcept { return failed_tool_; }
  std::uint8_t handle_of(int tool) const noexcept { return handles_[static_cast<std::size_t>(tool)]; }
  std::uint32_t baud() const noexcept { return line_baud_; }
  /// As the device tells them; empty where it does not.
  std::string_view api_revision() const noexcept { return api_revision_.view(); }
  std::string_view firmware() const noexcept { return firmware_.view(); }
  /// Vega, Lyra: API family G from revision 003 on.
  bool knows_frames() const noexcept;
  /// Polaris, Vicra, Spectra: their frame number runs at 60 Hz whatever they measure at.
  bool counts_at_60_hz() const noexcept;

 private:
  enum class Step : std::uint8_t {
    fast_line,
    fast_probe,
    slow_line,
    slow_probe,
    send_break,
    await_reset,
    settle_after_reset,
    probe_after_reset,
    settle_after_init,
    comm,
    settle_after_comm,
    comm_line,
    api_revision,
    firmware,
    version,
    rate,
    share,
    list_old,
    free_old,
    request,
    upload,
    list_new,
    initialise,
    initialise_wired,
    list_new_again,
    list_initialised,
    locate,
    describe,
    enable,
    start,
    beep,
    finished,
    failed,
  };
  void go(Step step) noexcept { step_ = step; }
  void fail(TrackerTrouble trouble, std::uint8_t error_code = 0) noexcept;
  bool busy_with_a_tool() const noexcept;
  void after_init() noexcept;
  void on_error(std::uint8_t code) noexcept;
  void on_okay() noexcept;
  void on_list(std::string_view text) noexcept;
  void next_old_handle() noexcept;
  void next_block() noexcept;
  bool lists_all_tools(std::string_view text) const noexcept;
  /// Goes to `again` for the next tool, or to `then` after the last.
  void next_tool(Step again, Step then) noexcept;
  void next_wireless(Step again, Step then) noexcept;
  void first_wireless(Step step, Step then) noexcept;
  void next_wired(Step again, Step then) noexcept;
  void after_wireless() noexcept;
  /// The handles of a list that are none of our wireless tools'.
  void keep_wired(const ndi::PortHandles& listed) noexcept;
  void locate(std::string_view text) noexcept;
  void all_located() noexcept;
  void on_version(std::string_view text) noexcept;
  StartAction set_rate() const noexcept;
  StartAction ask_or_tell() const noexcept;
  StartAction send(const ndi::Command& command, Nanos patience) const noexcept;
  StartAction tool_command() const noexcept;

  const NdiSettings& settings_;
  Step step_ = Step::failed;
  std::uint32_t wanted_baud_;  ///< the fastest that is still worth trying
  std::uint32_t line_baud_;    ///< at first the wanted one: a program before this may have set it
  std::array<std::uint8_t, kMaxTools> handles_{};
  std::array<std::uint8_t, 64> old_{};
  std::size_t old_count_ = 0;
  std::size_t old_next_ = 0;
  std::array<std::uint8_t, 64> wired_{};
  std::size_t wired_count_ = 0;
  std::size_t wired_next_ = 0;
  int wired_rounds_ = 0;  ///< a plug with two sensors shows the second once the first is initialised
  const bool has_wired_;
  ShortText api_revision_;
  ShortText firmware_;
  std::size_t tool_ = 0;
  std::size_t block_ = 0;
  TrackerTrouble trouble_ = TrackerTrouble::none;
  std::uint8_t error_code_ = 0;
  int failed_tool_ = -1;
};

}  // namespace orcart
