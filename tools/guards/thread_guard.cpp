// Blames a call on the innermost code that is not the runtime's, and files it there.
#include "tools/guards/thread_guard.hpp"

#include <execinfo.h>
#include <ucontext.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>

#include "tools/guards/system_calls.hpp"

#if ORCART_GUARDS
extern "C" {
// Taken out of their archive by being named: the functions they hold take the place of libc's.
extern const char orcart_interposed_heap;
extern const char orcart_interposed_lock;
}
#endif

namespace orcart::guards {
namespace {

// Initial-exec: the dynamic model may allocate at a thread's first touch, inside malloc.
[[gnu::tls_model("initial-exec")]] thread_local constinit ThreadGuard* guard_of_this_thread = nullptr;
[[gnu::tls_model("initial-exec")]] thread_local constinit std::uint64_t heap_calls = 0;

}  // namespace

std::string_view word_for(Ask ask) {
  constexpr std::array<std::string_view, kAskCount> kWords{"allocation",  "free",       "lock",
                                                           "system call", "page fault", "overrun"};
  return kWords[static_cast<std::size_t>(ask)];
}

std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept {
  if (!kGuardsWork) return std::nullopt;
  return heap_calls;
}

void note_call(Ask ask, const void* caller) noexcept {
  if (ask == Ask::allocation) ++heap_calls;
  if (guard_of_this_thread != nullptr) guard_of_this_thread->note(ask, -1, caller);
}

void note_system_call(int number, const void* caller) noexcept {
  if (guard_of_this_thread != nullptr) guard_of_this_thread->note(Ask::system_call, number, caller);
}

namespace {

void on_overrun(int, siginfo_t*, void* raw_context) {
  const int saved = errno;
  const void* at = nullptr;
#if defined(__x86_64__)
  at = std::bit_cast<const void*>(static_cast<ucontext_t*>(raw_context)->uc_mcontext.gregs[REG_RIP]);
#else
  (void)raw_context;
#endif
  if (guard_of_this_thread != nullptr) guard_of_this_thread->note(Ask::overrun, -1, at);
  errno = saved;
}

}  // namespace

void catch_overruns(int signal) {
  struct sigaction action {};
  action.sa_sigaction = on_overrun;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

bool ThreadGuard::arm(const GuardSet& set, bool in_step) noexcept {
#if ORCART_GUARDS
  static const volatile char interposed = orcart_interposed_heap + orcart_interposed_lock;
  (void)interposed;
#endif
  first_.depth = static_cast<std::size_t>(backtrace(first_.stack.data(), 2));  // its first call allocates
  first_ = {};
  in_step_ = in_step;
  watch_faults_ = kGuardsWork && set.page_faults;
  if (set.system_calls) system_calls_refused_ = !trap_system_calls_of_this_thread();
  if (watch_faults_) faults_.open();
  guard_of_this_thread = this;
  armed_ = true;
  return !system_calls_refused_;
}

void ThreadGuard::disarm() noexcept {
  if (!armed_) return;
  count_faults();
  armed_ = false;
  guard_of_this_thread = nullptr;
  faults_.close();
}

void ThreadGuard::enter_step(std::string_view stage) noexcept {
  count_faults();
  stage_ = stage;
  in_step_ = true;
}

void ThreadGuard::leave_step() noexcept {
  count_faults();
  ++steps_;
  in_step_ = false;
  stage_ = {};
}

std::uint64_t ThreadGuard::all(Ask ask) const noexcept {
  std::uint64_t sum = (ask == Ask::page_fault ? unplaced_faults_ : 0) + own_in_steps(ask) + own_between(ask) +
                      of_generated_code(ask);
  for (const auto& library : libraries_) sum += library[index(ask)];
  return sum;
}

void ThreadGuard::note(Ask ask, int system_call, const void* caller) noexcept {
  if (!armed_ || busy_) return;
  busy_ = true;  // whatever backtrace() itself does is not counted
  Finding finding{.ask = ask, .system_call = system_call, .in_step = in_step_, .stage = stage_, .count = 1};
  finding.caller = caller;
  Place place = code_.of(caller);
  const bool waiting = !in_step_ && ask == Ask::system_call;  // each kind of wait is one finding
  if (waiting) finding.caller = nullptr;
  const auto same = [&](const Finding& f) {
    return f.ask == ask && f.system_call == system_call && f.in_step == in_step_ &&
           f.caller == finding.caller;
  };
  const bool known = place.origin != Origin::runtime || waiting;
  if (known && std::any_of(findings_.begin(), findings_.begin() + finding_count_, same)) {
    file(finding, {.origin = Origin::program, .library = 0});
  } else {
    std::array<void*, Finding::kDeepest + 8> stack;
    take_faults();
    const auto depth = static_cast<std::size_t>(backtrace(stack.data(), static_cast<int>(stack.size())));
    if (watch_faults_)
      (void)faults_.take([](const void*) {});  // the unwinder's own, in tables it never read before
    const auto from = std::find(stack.begin(), stack.begin() + static_cast<std::ptrdiff_t>(depth), caller);
    const auto begin = from != stack.begin() + static_cast<std::ptrdiff_t>(depth)
                           ? static_cast<std::size_t>(from - stack.begin())
                           : std::size_t{0};
    finding.depth = std::min(depth - begin, Finding::kDeepest);
    std::copy_n(stack.begin() + static_cast<std::ptrdiff_t>(begin), finding.depth, finding.stack.begin());
    place = code_.blamed(finding.frames());
    if (!waiting && place.origin == Origin::program) {
      const auto frames = finding.frames();
      const auto own = std::ranges::find_if(
          frames, [&](const void* frame) { return code_.of(frame).origin == Origin::program; });
      if (own != frames.end()) finding.caller = *own;
    }
    file(finding, place);
  }
  busy_ = false;
}

void ThreadGuard::file(const Finding& finding, Place place) noexcept {
  if (first_.count == 0) first_ = finding;
  if (place.origin == Origin::library && place.library < kMostLibraries) {
    ++libraries_[place.library][index(finding.ask)];
    return;
  }
  if (place.origin == Origin::generated) {
    ++generated_[index(finding.ask)];
    return;
  }
  ++(finding.in_step ? own_in_steps_ : own_between_)[index(finding.ask)];
  for (std::size_t i = 0; i < finding_count_; ++i) {
    Finding& known = findings_[i];
    if (known.ask != finding.ask || known.system_call != finding.system_call ||
        known.in_step != finding.in_step || known.caller != finding.caller)
      continue;
    ++known.count;
    return;
  }
  if (finding_count_ < findings_.size()) findings_[finding_count_++] = finding;
}

void ThreadGuard::count_faults() noexcept {
  if (!armed_) return;
  busy_ = true;
  take_faults();
  busy_ = false;
}

// A fault may have happened inside a system call, where the kernel tells no place.
void ThreadGuard::take_faults() noexcept {
  if (!watch_faults_) return;
  std::uint64_t placed = 0;
  const auto blame = [&](const void* at) {
    ++placed;
    const Place place = code_.of(at);
    if (at == nullptr || place.origin == Origin::runtime) {
      ++unplaced_faults_;
      return;
    }
    Finding finding{.ask = Ask::page_fault, .in_step = in_step_, .stage = stage_, .count = 1};
    finding.stack[0] = const_cast<void*>(at);
    finding.depth = 1;
    finding.caller = at;
    file(finding, place);
  };
  const std::uint64_t fresh = faults_.take(blame);
  while (placed < fresh) blame(nullptr);
}

}  // namespace orcart::guards
