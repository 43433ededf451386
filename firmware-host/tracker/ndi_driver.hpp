// Drives an NDI tracker over a ByteLink: starts it, polls it, notices what goes wrong and starts it again.
// Tracker thread; one exchange a period; the step's own work fits 0.2 ms, waiting is the thread's business.
#pragma once

#include <array>
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
/// but the link's reopen(), while no tracker is there anyway.
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
  /// Why the tool is disabled, as its port says; "ready" where it is not.
  std::string_view disabled_reason(int tool) const noexcept;
  /// The trouble in one sentence, with the device's error and the tool. Allocates: not for a step().
  std::string trouble_sentence() const;

 private:
  enum class Phase : std::uint8_t { starting, polling, waiting };

  void start(Instant now) noexcept;
  void give_up(TrackerTrouble trouble, Instant now) noexcept;
  void retry(Instant now) noexcept;
  void advance_start(ExchangeEvent event, Instant now) noexcept;
  bool perform(const StartAction& action, Instant now) noexcept;
  void begin_polling(Instant now) noexcept;
  void advance_polling(ExchangeEvent event, Instant now, DriverReport& report) noexcept;
  void ask(Instant now) noexcept;
  void take_reply(Instant now, DriverReport& report) noexcept;
  void take_text(std::string_view text, Instant now) noexcept;
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
  bool ask_for_ports_ = false;
  bool asked_for_ports_ = false;
  bool started_before_ = false;
  Instant pause_until_{};
  Instant retry_at_{};
  Nanos back_off_;
  Instant next_poll_{};
  Instant next_due_{};

  TrackerReply reply_;
  std::array<std::uint16_t, kMaxTools> port_status_{};
  DriverCounters counters_;
};

}  // namespace orcart
