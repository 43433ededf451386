// Linux: mlockall, SCHED_FIFO, affinity and pre-touched stacks, each verified after it was asked for.
#include "realtime/kernel/realtime_rights.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include <alloca.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace orcart {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// The text after `key:` in /proc/self/status; empty where there is none.
std::string process_status(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(key + ":", 0) == 0) return line.substr(key.size() + 1);
  }
  return {};
}

bool may_lock_without_limit() {
  const std::uint64_t capabilities = std::strtoull(process_status("CapEff").c_str(), nullptr, 16);
  if ((capabilities >> CAP_IPC_LOCK & 1) != 0) return true;
  rlimit limit{};
  return getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
}

std::string memory_lack(const std::string& why) {
  return "Memory is not locked (" + why +
         "): a page fault can stop a real-time thread for milliseconds; set LimitMEMLOCK=infinity in the "
         "service, "
         "`ulimit -l unlimited` in the shell, or grant CAP_IPC_LOCK.";
}

std::string thread_words(const ThreadSpec& spec) {
  return "Thread '" + std::string(spec.name) + "'";
}

[[gnu::noinline]] void touch_below(std::size_t bytes) {
  constexpr std::size_t kSmallestPage = 4096;
  auto* const memory = static_cast<volatile char*>(alloca(bytes));
  for (std::size_t i = 0; i < bytes; i += kSmallestPage) memory[i] = 0;
}

/// Touches the calling thread's stack down to its end, or as far as its size in the spec where it has more.
bool prefault_stack(std::size_t wanted_bytes) {
  constexpr std::size_t kSpareBytes =
      16 * 1024;  // touch_below itself, and the guard page, which getstack counts in
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return false;
  void* lowest = nullptr;
  std::size_t bytes = 0;
  const int error = pthread_attr_getstack(&attributes, &lowest, &bytes);
  pthread_attr_destroy(&attributes);
  if (error != 0) return false;
  const auto here = reinterpret_cast<std::uintptr_t>(&attributes);
  const std::uintptr_t left = here - reinterpret_cast<std::uintptr_t>(lowest);
  const std::size_t touchable = std::min<std::size_t>(left, wanted_bytes);
  if (touchable <= kSpareBytes) return false;
  touch_below(touchable - kSpareBytes);
  return true;
}

void take_stack(const ThreadSpec& spec, RealtimeRights& rights) {
  rights.stack_prefaulted = prefault_stack(spec.stack_bytes);
  if (rights.stack_prefaulted) return;
  rights.lacks.push_back(thread_words(spec) +
                         " could not touch its stack beforehand: its first deep call faults "
                         "pages in; give it a stack_bytes of 65536 or more.");
}

void take_processor(const ThreadSpec& spec, RealtimeRights& rights) {
  if (spec.cpu < 0) return;
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  CPU_SET(static_cast<unsigned>(spec.cpu), &wanted);
  cpu_set_t got;
  CPU_ZERO(&got);
  int error =
      spec.cpu < CPU_SETSIZE ? pthread_setaffinity_np(pthread_self(), sizeof(wanted), &wanted) : EINVAL;
  if (error == 0) error = pthread_getaffinity_np(pthread_self(), sizeof(got), &got);
  rights.pinned = error == 0 && CPU_EQUAL(&wanted, &got);
  if (rights.pinned) return;
  rights.lacks.push_back(
      thread_words(spec) + " is not pinned to processor " + std::to_string(spec.cpu) + " (" + reason(error) +
      "): it may be moved to a cold cache; name a processor from 0 to " +
      std::to_string(sysconf(_SC_NPROCESSORS_ONLN) - 1) + " that the process may use, or -1.");
}

void take_priority(const ThreadSpec& spec, RealtimeRights& rights) {
  if (spec.fifo_priority <= 0) return;
  const sched_param wanted{.sched_priority = spec.fifo_priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  sched_param got{};
  int policy = SCHED_OTHER;
  rights.fifo = error == 0 && pthread_getschedparam(pthread_self(), &policy, &got) == 0 &&
                policy == SCHED_FIFO && got.sched_priority == spec.fifo_priority;
  if (rights.fifo) return;
  const std::string priority = std::to_string(spec.fifo_priority);
  rights.lacks.push_back(thread_words(spec) + " runs without SCHED_FIFO priority " + priority + " (" +
                         reason(error) + "): any other program can delay it; set LimitRTPRIO=" + priority +
                         " in the service, `ulimit -r " + priority +
                         "` in the shell, or grant CAP_SYS_NICE.");
}

}  // namespace

RealtimeRights lock_process_memory() {
  RealtimeRights rights;
  if (!may_lock_without_limit()) {
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    rights.lacks.push_back(
        memory_lack("RLIMIT_MEMLOCK is " + std::to_string(limit.rlim_cur / 1024) + " KiB"));
    return rights;
  }
  // On fault: what was touched before arming stays; the GL driver's compiler, 100 MB of it, is not dragged
  // in.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    rights.lacks.push_back(memory_lack(reason(errno)));
    return rights;
  }
  // Sanitizers answer mlockall with success and do nothing; the kernel knows.
  rights.memory_locked = std::strtoull(process_status("VmLck").c_str(), nullptr, 10) > 0;
  if (!rights.memory_locked)
    rights.lacks.push_back(memory_lack("accepted, but the kernel reports nothing locked"));
  return rights;
}

void unlock_process_memory() noexcept {
  munlockall();
}

RealtimeRights acquire_thread_rights(const ThreadSpec& spec) {
  constexpr std::size_t kLongestName = 15;
  pthread_setname_np(pthread_self(), std::string(spec.name.substr(0, kLongestName)).c_str());
  prctl(PR_SET_TIMERSLACK, 1UL);  // without FIFO the system may sleep 50 us longer than asked
  RealtimeRights rights;
  take_stack(spec, rights);
  take_processor(spec, rights);
  take_priority(spec, rights);
  return rights;
}

}  // namespace orcart
