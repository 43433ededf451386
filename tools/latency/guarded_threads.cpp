// A stage within a stage: tells the guard when a step begins and ends.
#include "tools/latency/guarded_threads.hpp"

#include <pthread.h>
#include <sys/syscall.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "tools/guards/system_calls.hpp"

namespace orcart {

using guards::Ask;

namespace {
constexpr int kOverrunSignal = SIGURG;  // ignored where nobody asked for it
}

struct GuardedThreads::Thread {
  Thread(const ThreadSpec& spec, const guards::CodeMap& code)
      : guard(std::make_unique<guards::ThreadGuard>(spec.name, code)), priority(spec.fifo_priority) {}
  std::unique_ptr<guards::ThreadGuard> guard;
  int priority;
  std::atomic<bool> armed{false};
  // What the watcher looks at; one writer each, a value alone, relaxed without partners.
  std::atomic<pthread_t> id{};
  std::atomic<std::int64_t> late_from_ns{INT64_MAX};
};

class GuardedThreads::GuardedStage final : public Stage {
 public:
  GuardedStage(GuardedThreads& all, Thread& thread, Nanos bound, Stage& stage)
      : all_(all), thread_(thread), bound_(bound), stage_(stage) {}

  std::string_view name() const noexcept override { return stage_.name(); }
  void enter_thread() noexcept override { stage_.enter_thread(); }
  // The first of a thread's stages to leave is the last one; what leaving costs is nobody's concern.
  void leave_thread() noexcept override {
    thread_.guard->disarm();
    stage_.leave_thread();
  }
  StepReport step(Instant now) noexcept override {
    guards::ThreadGuard& guard = *thread_.guard;
    // Partner: the release in arm().
    if (!guard.armed() && all_.wanted_.load(std::memory_order_acquire)) {
      guard.arm(all_.set_, false);
      thread_.id.store(pthread_self(), std::memory_order_relaxed);
      thread_.armed.store(true, std::memory_order_release);  // partner: the acquire in ask_late_steps()
    }
    guard.enter_step(stage_.name());
    thread_.late_from_ns.store(nanos_since_zero(now + bound_), std::memory_order_relaxed);
    const StepReport report = stage_.step(now);
    thread_.late_from_ns.store(INT64_MAX, std::memory_order_relaxed);
    guard.leave_step();
    return report;
  }

 private:
  GuardedThreads& all_;
  Thread& thread_;
  Nanos bound_;
  Stage& stage_;
};

GuardedThreads::GuardedThreads(guards::GuardSet set) : set_(set) {}
GuardedThreads::~GuardedThreads() = default;

Stage& GuardedThreads::around(const ThreadSpec& thread, StageId id, Stage& stage) {
  if (thread.fifo_priority == 0) return stage;
  const auto known =
      std::ranges::find(threads_, thread.name, [](const auto& one) { return one->guard->thread(); });
  Thread& home =
      known != threads_.end() ? **known : *threads_.emplace_back(std::make_unique<Thread>(thread, code_));
  stages_.push_back(std::make_unique<GuardedStage>(*this, home, row_of(id).software.bound, stage));
  return *stages_.back();
}

void GuardedThreads::arm() {
  guards::catch_overruns(kOverrunSignal);
  code_.refresh();
  wanted_.store(true, std::memory_order_release);  // partner: the acquire in step()
}

void GuardedThreads::ask_late_steps(Instant now) {
  for (const auto& thread : threads_) {
    // Partner of the acquire: the release in step().
    if (!thread->armed.load(std::memory_order_acquire)) continue;
    std::int64_t late_from = thread->late_from_ns.load(std::memory_order_relaxed);
    if (nanos_since_zero(now) < late_from) continue;
    if (thread->late_from_ns.compare_exchange_strong(late_from, INT64_MAX, std::memory_order_relaxed))
      pthread_kill(thread->id.load(std::memory_order_relaxed), kOverrunSignal);
  }
}

bool GuardedThreads::all_armed() const {
  return std::ranges::all_of(
      threads_, [](const auto& thread) { return thread->armed.load(std::memory_order_relaxed); });
}

std::vector<const guards::ThreadGuard*> GuardedThreads::guards() const {
  std::vector<const guards::ThreadGuard*> all;
  for (const auto& thread : threads_) all.push_back(thread->guard.get());
  return all;
}

namespace {

bool may_wait_by(int system_call) {
  constexpr std::array kWaits{SYS_clock_nanosleep, SYS_ppoll, SYS_restart_syscall, SYS_clock_gettime};
  return std::ranges::find(kWaits, system_call) != kWaits.end();
}

std::string times(std::uint64_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace

std::vector<std::string> faults_of(const GuardedThreads& threads) {
  std::vector<std::string> faults;
  for (const guards::ThreadGuard* guard : threads.guards()) {
    for (const guards::Finding& finding : guard->findings()) {
      if (!finding.in_step && finding.ask == Ask::system_call && may_wait_by(finding.system_call)) continue;
      std::string what = times(finding.count, word_for(finding.ask));
      if (finding.ask == Ask::system_call)
        what += " (" + guards::name_of_system_call(finding.system_call) + ")";
      faults.push_back("thread " + std::string(guard->thread()) + ", " +
                       (finding.in_step ? "stage " + std::string(finding.stage) : "between steps") + ": " +
                       what + " in " + std::to_string(guard->steps()) + " guarded steps, from\n" +
                       guards::words_for(finding.frames()));
    }
  }
  return faults;
}

std::vector<std::string> library_lines(const GuardedThreads& threads) {
  std::vector<std::string> lines;
  constexpr std::array kAsks{Ask::allocation, Ask::free, Ask::lock, Ask::system_call, Ask::page_fault};
  const auto line = [&](const guards::ThreadGuard& guard, std::string_view library, auto&& count) {
    std::string text;
    for (const Ask ask : kAsks)
      if (count(ask) > 0) text += (text.empty() ? " " : ", ") + times(count(ask), word_for(ask));
    if (!text.empty())
      lines.push_back(std::string(guard.thread()) + ": " + std::string(library) + text + " in " +
                      std::to_string(guard.steps()) + " steps");
  };
  for (const guards::ThreadGuard* guard : threads.guards()) {
    const std::size_t libraries = std::min(guard->code().libraries(), guards::ThreadGuard::kMostLibraries);
    for (std::uint16_t i = 0; i < libraries; ++i)
      line(*guard, guard->code().name_of(i), [&](Ask ask) { return guard->of_library(i, ask); });
    line(*guard, "code generated by the driver", [&](Ask ask) { return guard->of_generated_code(ask); });
    line(*guard, "the C runtime, or inside a system call",
         [&](Ask ask) { return ask == Ask::page_fault ? guard->unplaced_faults() : 0; });
  }
  return lines;
}

}  // namespace orcart
