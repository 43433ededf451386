// What one thread asks of the heap, of locks, of the kernel and of the pager while it is guarded, and who
// asked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "tools/guards/code_map.hpp"
#include "tools/guards/page_faults.hpp"

namespace orcart::guards {

/// False under ASan and TSan, which bring a malloc of their own: there every count stays 0, and a test that
/// needs the guards to bite skips.
constexpr bool kGuardsWork = ORCART_GUARDS != 0;

enum class Ask : std::uint8_t { allocation, free, lock, system_call, page_fault, overrun };
inline constexpr std::size_t kAskCount = 6;
std::string_view word_for(Ask ask);

/// Which guards a thread wants.
struct GuardSet {
  bool heap_and_locks = true;
  bool system_calls = false;  ///< for good: the filter stays on the thread until it ends, counted or not
  bool page_faults = false;
};

/// One call site of the program that asked for something, and how often.
struct Finding {
  static constexpr std::size_t kDeepest = 20;
  Ask ask = Ask::allocation;
  int system_call = -1;    ///< its number, where ask is system_call
  bool in_step = true;     ///< false: between steps, where the thread waits for its next turn
  std::string_view stage;  ///< the step's stage; empty between steps
  std::uint64_t count = 0;
  std::array<void*, kDeepest> stack{};  ///< innermost first
  std::size_t depth = 0;
  const void* caller = nullptr;
  std::span<void* const> frames() const noexcept { return {stack.data(), depth}; }
};

/// Counts one thread's calls between arm() and disarm(). arm, enter_step, leave_step and disarm are that
/// thread's; the rest is to be read once it is disarmed. One guard a thread at a time; allocates nothing once
/// armed.
class ThreadGuard {
 public:
  static constexpr std::size_t kMostFindings = 24;
  static constexpr std::size_t kMostLibraries = 160;
  using LibraryCounts = std::array<std::array<std::uint64_t, kAskCount>, kMostLibraries>;

  /// `code` is lent; `thread` is a literal's.
  ThreadGuard(std::string_view thread, const CodeMap& code) noexcept : thread_(thread), code_(code) {}
  ThreadGuard(const ThreadGuard&) = delete;
  ThreadGuard& operator=(const ThreadGuard&) = delete;
  ~ThreadGuard() { disarm(); }

  /// From now on all that this thread does counts; inside a step where `in_step`. False: the system refused
  /// one of the guards (see lacks()), and the others are armed.
  bool arm(const GuardSet& set, bool in_step) noexcept;
  void enter_step(std::string_view stage) noexcept;
  void leave_step() noexcept;
  void disarm() noexcept;
  bool armed() const noexcept { return armed_; }

  std::string_view thread() const noexcept { return thread_; }
  /// Calls by the program's own code, inside steps and between them.
  std::uint64_t own_in_steps(Ask ask) const noexcept { return own_in_steps_[index(ask)]; }
  std::uint64_t own_between(Ask ask) const noexcept { return own_between_[index(ask)]; }
  /// Calls by other libraries, and by the code they generated, inside steps.
  std::uint64_t of_library(std::uint16_t library, Ask ask) const noexcept {
    return libraries_[library][index(ask)];
  }
  std::uint64_t of_generated_code(Ask ask) const noexcept { return generated_[index(ask)]; }
  /// Page faults whose instruction is the runtime's (memcpy) or not told: of whoever the thread serves.
  std::uint64_t unplaced_faults() const noexcept { return unplaced_faults_; }
  /// All calls of a kind, whoever made them.
  std::uint64_t all(Ask ask) const noexcept;
  /// The first kMostFindings call sites of the program, in the order in which they were met.
  std::span<const Finding> findings() const noexcept { return {findings_.data(), finding_count_}; }
  /// The first call of all that was counted, whoever made it; null where none was.
  const Finding* first() const noexcept { return first_.count > 0 ? &first_ : nullptr; }
  std::uint64_t steps() const noexcept { return steps_; }
  const CodeMap& code() const noexcept { return code_; }
  bool system_calls_refused() const noexcept { return system_calls_refused_; }
  /// False: faults are counted, but where they happened is not known (no perf events).
  bool sites_of_faults() const noexcept { return faults_.knows_sites(); }

  /// For the interposed functions and the signal handler. `caller`: who called, in the caller's own code;
  /// frames of the stack before it are the guard's.
  void note(Ask ask, int system_call, const void* caller) noexcept;

 private:
  static constexpr std::size_t index(Ask ask) noexcept { return static_cast<std::size_t>(ask); }
  void file(const Finding& finding, Place place) noexcept;
  void count_faults() noexcept;
  void take_faults() noexcept;  ///< while busy_

  std::string_view thread_;
  const CodeMap& code_;
  bool armed_ = false, busy_ = false, in_step_ = false, watch_faults_ = false, system_calls_refused_ = false;
  std::string_view stage_;
  std::uint64_t steps_ = 0;
  std::uint64_t unplaced_faults_ = 0;
  std::array<std::uint64_t, kAskCount> own_in_steps_{}, own_between_{}, generated_{};
  LibraryCounts libraries_{};
  std::array<Finding, kMostFindings> findings_{};
  std::size_t finding_count_ = 0;
  Finding first_;
  PageFaults faults_;
};

/// Heap calls of the calling thread since it began, guarded or not; nothing under sanitizers.
std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept;

/// Called by the interposed functions: counts for the calling thread's guard, if it has one.
void note_call(Ask ask, const void* caller) noexcept;
/// Makes `signal` file where its thread stands as an overrun of the step it is in; sent by whoever watches.
void catch_overruns(int signal);
/// Called by the signal handler, with the instruction behind the call.
void note_system_call(int number, const void* caller) noexcept;

}  // namespace orcart::guards
