// Runs a list of stages on one real thread: at a fixed rate in absolute time, or woken by input.
#pragma once

#include <atomic>
#include <semaphore>

#include <pthread.h>

#include "realtime/base/result.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/realtime_rights.hpp"
#include "realtime/kernel/thread_loop.hpp"

namespace orcart {

/// The owner's thread constructs, starts, stops. After start() returned, the new thread allocates nothing of
/// its own.
class WorkerThread {
 public:
  /// `clock` and all that the plan lends outlive this.
  WorkerThread(ThreadPlan plan, Clock& clock) : plan_(std::move(plan)), clock_(clock), loop_(plan_) {}
  ~WorkerThread() { stop(); }
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;

  /// Starts the thread and waits until it has asked for its rights; once. Lacking rights are no error: see
  /// rights().
  Result<void> start();

  /// Lets the turn finish and joins: within a period, or the event_timeout of a thread with a WakeSource.
  /// Idempotent.
  void stop() noexcept;

  bool running() const noexcept { return started_; }
  /// What the thread was granted; complete once start() has returned.
  const RealtimeRights& rights() const noexcept { return rights_; }
  /// Any thread.
  const ThreadLedger& ledger() const noexcept { return loop_.ledger(); }
  const ThreadPlan& plan() const noexcept { return plan_; }

 private:
  static void* entry(void* self);
  void run() noexcept;
  void sleep_until(Instant due) noexcept;
  void run_stages() noexcept;

  ThreadPlan plan_;
  Clock& clock_;
  ThreadLoop loop_;
  RealtimeRights rights_;
  std::binary_semaphore ready_{0};
  std::atomic<bool> stop_wanted_{false};
  pthread_t thread_{};
  bool started_ = false;
};

}  // namespace orcart
