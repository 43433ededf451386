// Puts the guards on every real-time thread of a running cart: heap, locks, system calls, page faults.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "firmware-host/app/cart.hpp"
#include "tools/guards/thread_guard.hpp"

namespace orcart {

/// Wraps the stages of threads with a FIFO priority; the others are let be. Each thread arms itself at its
/// first step after arm(), and is guarded from there on, between its steps as well, until it ends.
class GuardedThreads final : public StageWrapper {
 public:
  explicit GuardedThreads(guards::GuardSet set = {.system_calls = true, .page_faults = true});
  ~GuardedThreads() override;

  Stage& around(const ThreadSpec& thread, StageId id, Stage& stage) override;

  /// Once the libraries have been loaded and the first steps were made; any thread, once.
  void arm();
  /// Every guarded thread has armed itself.
  bool all_armed() const;

  /// Any thread, over and over: lets each step that is over its hard bound by `now` tell where it stands,
  /// once.
  void ask_late_steps(Instant now);

  /// After the cart has stopped: one guard a thread, by the order of its first stage.
  std::vector<const guards::ThreadGuard*> guards() const;

 private:
  class GuardedStage;
  struct Thread;
  guards::GuardSet set_;
  guards::CodeMap code_;
  std::atomic<bool> wanted_{false};
  std::vector<std::unique_ptr<Thread>> threads_;
  std::vector<std::unique_ptr<GuardedStage>> stages_;
};

/// Every call site of the program that the guards found where nothing may be asked, one sentence with its
/// stack each. Between steps a thread may wait and read its clocks: those calls are no findings.
std::vector<std::string> faults_of(const GuardedThreads& threads);

/// What other libraries asked inside our steps, one line a library and thread: "render: libgallium 312
/// allocations, ...".
std::vector<std::string> library_lines(const GuardedThreads& threads);

}  // namespace orcart
