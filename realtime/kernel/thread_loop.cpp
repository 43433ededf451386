// Keeps one thread's ledger, trace and pace.
#include "realtime/kernel/thread_loop.hpp"

#include <algorithm>

#include "realtime/kernel/one_writer.hpp"

namespace orcart {

void ThreadLoop::begin(Instant first) noexcept {
  if (plan_.spec.rate_hz > 0) pacer_.emplace(period_of(plan_.spec.rate_hz), plan_.spec.overrun, first);
}

Instant ThreadLoop::wake_by(Instant now) const noexcept {
  const Instant timeout = plan_.wake != nullptr ? now + plan_.spec.event_timeout : Instant::max();
  return pacer_ ? std::min(pacer_->due(), timeout) : timeout;
}

void ThreadLoop::woke(Instant now, Instant due) noexcept {
  on_period_ = pacer_ && now >= pacer_->due();
  add_alone(ledger_.turns, 1);
  if (now >= due) ledger_.lateness.record(now - due);
  trace({.at = now, .kind = TraceKind::wake, .value = (now - due).count()});
}

void ThreadLoop::stepped(std::size_t stage, const StepTiming& timing, const StepReport& report) noexcept {
  if (!report.worked) return;
  if (!plan_.ledgers.empty()) plan_.ledgers[stage]->record(timing, report);
  trace({.at = timing.at,
         .length = timing.wall,
         .stage = static_cast<std::uint16_t>(stage),
         .kind = TraceKind::step,
         .value = report.items});
}

void ThreadLoop::turn_over(Instant now) noexcept {
  if (!on_period_) return;
  const std::uint64_t slips_before = pacer_->slips();
  const std::uint64_t skipped = pacer_->turn_over(now);
  if (pacer_->slips() == slips_before) return;
  add_alone(ledger_.slips, 1);
  add_alone(ledger_.skipped, skipped);
  trace({.at = now, .kind = TraceKind::slip, .value = static_cast<std::int64_t>(skipped)});
}

void ThreadLoop::trace(const TraceEvent& event) noexcept {
  if (plan_.trace != nullptr) plan_.trace->write(event);
}

}  // namespace orcart
