// Drives an NDI tracker over a ByteLink: starts it, polls it, notices what goes wrong and starts it again.
// Tracker thread; one exchange a period; the step's own work fits 0.2 ms, waiting is the thread's business.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include "board/ports/byte_link.hpp"
#include "firmware-host/tracker/exchange.hpp"
#include "firmware-host/tracker/link_health.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "firmware-host/tracker/ndi_settings.hpp"
#include "firmware-host/tracker/start_sequence.hpp"
#include "firmware-host/tracker/tracker_reply.hpp"
#include "firmware-host/tracker/trouble.hpp"

namespace orcart {

struct DriverReport {
  bool worked = false;     ///< bytes were sent or a reply was handled
  bool new_reply = false;  ///< reply() is from a device frame that was not reported before
  TrackerHealth health = TrackerHealth::starting;
  TrackerTrouble trouble = TrackerTrouble::none;
};

struct DriverCounters {
  std::uint64_t polls = 0;
  std::uint64_t replies = 0;  ///< good ones, repeats included
  std::uint64_t repeats = 0;  ///< replies that carried the same device frame again
  std::uint64_t crc_bad = 0;  ///< damaged replies
  std::uint64_t timeouts = 0;
  std::uint64_t resyncs = 0;  ///< replies found behind bytes that belonged to none, and polls after damage
  std::uint64_t unknown_handles = 0;
  std::uint64_t skipped_polls = 0;  ///< slots in which the poll before was still out
  std::uint64_t restarts = 0;       ///< starts after the first
  std::array<std::uint64_t, kMaxTools> missing{};
  std::array<std::uint64_t, kMaxTools> disabled{};
};

/// The settings must have passed check(). One thread; nothing allocates after construction; nothing blocks
/// but the link's reopen(), while no tracker is there anyway; the pause before the next try begins after it.
class NdiDriver {
 public:
  NdiDriver(NdiSettings settings, ByteLink& link);
  NdiDriver(const NdiDriver&) = delete;
  NdiDriver& operator=(const NdiDriver&) = delete;

  /// Does what is due at `now`. To be called when the link has input and when next_due() has come.
  DriverReport step(Instant now) noexcept;
  /// What the link's wait() should be bounded by.
  Instant next_due() const noexcept { return next_due_; }

  /// The newest completed poll; valid once a report has said new_reply.
  const TrackerReply& reply() const noexcept { return reply_; }
  const DriverCounters& counters() const noexcept { return counters_; }
  TrackerHealth health() const noexcept { return health_; }
  TrackerTrouble trouble() const noexcept { return trouble_; }
  std::uint32_t baud() const noexcept { return start_.baud(); }
  std::string_view firmware() const noexcept { return start_.firmware(); }
  std::string_view api_revision() const noexcept { return start_.api_revision(); }
  /// At what rate the device is thought to count its frames, whatever it measures at; once it has been
  /// started.
  double counter_hz() const noexcept { return counter_hz_; }
  double wished_rate_hz() const noexcept { return settings_.device_rate_hz; }
  /// How poses are asked for now; never automatic while polling.
  PollForm poll_form() const noexcept { return form_; }
  /// All that the device has told of itself since it was started; the bump detector among it.
  const ndi::SystemAlerts& alerts() const noexcept { return alerts_; }
  /// The sensor was knocked: what is registered to tracker space has to be verified on a landmark. Stands
  /// until somebody says that this was done.
  bool bumped() const noexcept { return alerts_.bumped(); }
  void forget_alerts() noexcept { alerts_ = {}; }
  /// Lets the device beep 1 to 9 times in one of the next polls' place. Any thread.
  void beep(int times) noexcept { beeps_wanted_.store(times, std::memory_order_relaxed); }
  /// Why the tool is disabled, as its port says; "ready" where it is not.
  std::string_view disabled_reason(int tool) const noexcept;
  /// The trouble, and what does not please while it tracks.
  TrackerState state() const noexcept;
  /// The state's trouble in one sentence, with the device's error and the tool; "fine" where there is none.
  /// Any thread. Allocates: not for a step().
  std::string trouble_sentence(const TrackerState& state) const;
  std::string trouble_sentence() const { return trouble_sentence(state()); }
  /// What else the state says, in one sentence; empty where nothing. As above.
  std::string remark(const TrackerState& state) const;

 private:
  enum class Phase : std::uint8_t { starting, polling, waiting };
  /// What the exchange under way was about.
  enum class Asked : std::uint8_t { poses, ports, alerts, beep };

  void start(Instant now) noexcept;
  void give_up(TrackerTrouble trouble, Instant now) noexcept;
  void retry(Instant now) noexcept;
  void advance_start(ExchangeEvent event, Instant now) noexcept;
  bool perform(const StartAction& action, Instant now) noexcept;
  void begin_polling(Instant now) noexcept;
  void advance_polling(ExchangeEvent event, Instant now, DriverReport& report) noexcept;
  void ask(Instant now) noexcept;
  void take_reply(Instant now, DriverReport& report) noexcept;
  void take_poses(Instant now, DriverReport& report) noexcept;
  Result<ndi::TrackingReply, ndi::ReplyFault> parsed() const noexcept;
  void take_text(std::string_view text, Instant now) noexcept;
  void take_answer(std::string_view text, Instant now) noexcept;
  void take_refusal(std::uint8_t code, Instant now) noexcept;
  void notice(const ndi::TrackingReply& said) noexcept;
  ndi::Command next_command() noexcept;
  PollForm best_form() const noexcept;
  void take_readings(const ndi::TrackingReply& said, Instant now, DriverReport& report) noexcept;
  ToolReading judged(const ndi::HandleReading& said) const noexcept;
  int tool_of(std::uint8_t handle) const noexcept;
  void take_port_list(std::string_view text) noexcept;
  void watch(Instant now) noexcept;
  void plan(Instant now) noexcept;

  const NdiSettings settings_;
  ByteLink& link_;
  Exchange exchange_;
  StartSequence start_;
  LinkHealth watch_;
  const Nanos period_;
  const Nanos poll_patience_;

  Phase phase_ = Phase::waiting;
  TrackerHealth health_ = TrackerHealth::starting;
  TrackerTrouble trouble_ = TrackerTrouble::none;
  bool link_is_down_ = false;
  bool in_pause_ = false;
  PollForm form_ = PollForm::bx;
  Asked asked_ = Asked::poses;
  bool ask_for_ports_ = false;
  bool ask_for_alerts_ = false;
  ndi::SystemAlerts alerts_;
  ndi::SystemAlerts told_;  ///< by the newest frame of BX2
  std::atomic<int> beeps_wanted_{0};
  bool started_before_ = false;
  double counter_hz_ = settings_.device_rate_hz;
  int refusals_in_a_row_ = 0;      ///< of polls, without a good reply in between
  std::uint8_t refused_with_ = 0;  ///< the code of the ERRORhh behind the newest trouble; 0 where none is
  int failed_tool_ = -1;  ///< the tool that the newest failed start was busy with; -1 where with none
  Instant pause_until_{};
  Instant retry_at_{};
  bool opened_in_vain_ = false;  ///< in the step before: reopen() took its time, of which `now` knew nothing
  Nanos back_off_;
  Nanos pause_{};  ///< the one under way, or the last
  Instant next_poll_{};
  Instant next_due_{};

  TrackerReply reply_;
  std::array<std::uint16_t, kMaxTools> port_status_{};
  DriverCounters counters_;
};

}  // namespace orcart
