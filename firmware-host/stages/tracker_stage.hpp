// Steps the tracker's driver and makes samples of its replies, stamped in host time. Thread: tracker. Rate:
// when the line has input or the driver is due. Budget: topology, row "tracker".
#pragma once

#include <algorithm>
#include <atomic>

#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/tracker/ndi_driver.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/sync/clock_fit.hpp"
#include "realtime/sync/counter_rate.hpp"

namespace orcart {

/// Tool 0 of the driver is the scope, tool 1 the reference, tool 2, where there is one, a turning scope's
/// second marker.
class TrackerStage final : public Stage {
 public:
  /// The fit's rate is the device's to tell: what the driver thinks of it, then what its replies say.
  TrackerStage(NdiDriver& driver, const ClockFitSettings& clock_fit, Lanes& lanes)
      : driver_(driver), fit_settings_(clock_fit), fit_(clock_fit), lanes_(lanes) {}

  std::string_view name() const noexcept override { return "tracker"; }
  StepReport step(Instant now) noexcept override;

  /// What the driver has to tell. Any thread.
  TrackerState state() const noexcept { return state_.load(std::memory_order_relaxed); }

  const ClockFit& clock_fit() const noexcept { return fit_; }

 private:
  static constexpr Nanos kStateEvery = 500ms;  ///< while all is well: only a log waits for it

  PoseSample sample_of(const TrackerReply& reply) noexcept;
  void tell_state(TrackerTrouble trouble, Instant now) noexcept;
  void count(std::uint32_t device_frame, Instant arrived_at) noexcept;

  NdiDriver& driver_;
  ClockFitSettings fit_settings_;
  ClockFit fit_;
  double assumed_hz_ = fit_settings_.rate_hz;
  CounterRate counter_{fit_settings_.rate_hz};
  Lanes& lanes_;
  TrackerNews news_;
  Instant state_due_{};
  std::atomic<TrackerState> state_{TrackerState{}};  ///< relaxed, without a partner: it stands for itself
  static_assert(std::atomic<TrackerState>::is_always_lock_free);
};

/// What the tracker's thread sleeps on: the line, and what the driver has planned.
class TrackerWake final : public WakeSource {
 public:
  TrackerWake(ByteLink& link, const NdiDriver& driver) : link_(link), driver_(driver) {}
  void wait(Instant deadline) noexcept override { link_.wait(std::min(deadline, driver_.next_due())); }
  Instant next_event() const noexcept override { return std::min(link_.next_event(), driver_.next_due()); }

 private:
  ByteLink& link_;
  const NdiDriver& driver_;
};

}  // namespace orcart
