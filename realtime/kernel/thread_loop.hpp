// The book-keeping of one thread's loop (when to wake, what was late, what each step took), apart from what
// makes time pass: the real thread and the simulated one share it to the letter.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "realtime/base/instant.hpp"
#include "realtime/kernel/histogram.hpp"
#include "realtime/kernel/pacer.hpp"
#include "realtime/kernel/thread_plan.hpp"

namespace orcart {

/// What a thread's loop did. Its thread writes, any thread reads; each count is relaxed and alone, without
/// partner.
struct ThreadLedger {
  Histogram lateness;                   ///< awake minus due, of each wake-up that was due at a known instant
  std::atomic<std::uint64_t> turns{0};  ///< times that the stages were run
  std::atomic<std::uint64_t> slips{0};  ///< turns not over when the next was due
  std::atomic<std::uint64_t> skipped{0};  ///< periods without a turn
};

/// One thread: begin, then over and over wake_by, woke, stepped for each stage, turn_over.
class ThreadLoop {
 public:
  /// The plan is lent and checked.
  explicit ThreadLoop(const ThreadPlan& plan) noexcept : plan_(plan) {}

  /// The first period is due at `first`.
  void begin(Instant first) noexcept;

  /// When the thread must be awake at the latest, if it goes to sleep at `now`.
  Instant wake_by(Instant now) const noexcept;

  /// It is awake; `due` is what wake_by said. Before `due`, input woke it.
  void woke(Instant now, Instant due) noexcept;

  void stepped(std::size_t stage, const StepTiming& timing, const StepReport& report) noexcept;

  void turn_over(Instant now) noexcept;

  const ThreadPlan& plan() const noexcept { return plan_; }
  const ThreadLedger& ledger() const noexcept { return ledger_; }

 private:
  void trace(const TraceEvent& event) noexcept;

  const ThreadPlan& plan_;
  std::optional<Pacer> pacer_;
  bool on_period_ = false;  ///< this turn is one of the pacer's
  ThreadLedger ledger_;
};

}  // namespace orcart
