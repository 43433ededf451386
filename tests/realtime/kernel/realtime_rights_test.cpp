// The report on real-time rights tells the truth on whatever machine this is: privileged, container or
// sanitizer.
#include "realtime/kernel/realtime_rights.hpp"

#include <fstream>
#include <thread>

#include <pthread.h>
#include <sched.h>

#include <gtest/gtest.h>

namespace orcart {
namespace {

/// Asks on a thread of its own, so that the test program keeps its priority, and looks at it from inside.
template <class Look>
RealtimeRights ask(const ThreadSpec& spec, Look look) {
  RealtimeRights rights;
  std::thread([&] {
    rights = acquire_thread_rights(spec);
    look();
  }).join();
  return rights;
}

std::uint64_t locked_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmLck:", 0) == 0) return std::stoull(line.substr(6));
  }
  return 0;
}

TEST(RealtimeRights, SayFifoExactlyWhereTheSystemDoes) {
  int policy = -1;
  sched_param given{};
  const RealtimeRights rights = ask({.name = "fifo", .fifo_priority = 20},
                                    [&] { pthread_getschedparam(pthread_self(), &policy, &given); });
  EXPECT_EQ(rights.fifo, policy == SCHED_FIFO && given.sched_priority == 20);
  EXPECT_EQ(rights.degraded(), !rights.fifo);
}

TEST(RealtimeRights, NameTheThreadAndTheRemedyForEachLack) {
  const RealtimeRights rights = ask({.name = "fifo", .fifo_priority = 20}, [] {});
  for (const std::string& lack : rights.lacks) {
    EXPECT_NE(lack.find("'fifo'"), std::string::npos) << lack;
    EXPECT_NE(lack.find("LimitRTPRIO=20"), std::string::npos) << lack;
  }
}

TEST(RealtimeRights, PinToAProcessorThatExists) {
  const int here = sched_getcpu();
  cpu_set_t set;
  CPU_ZERO(&set);
  const RealtimeRights rights =
      ask({.name = "pin", .cpu = here}, [&] { pthread_getaffinity_np(pthread_self(), sizeof(set), &set); });
  EXPECT_EQ(rights.pinned, CPU_COUNT(&set) == 1 && CPU_ISSET(here, &set));
}

TEST(RealtimeRights, RefuseAProcessorThatDoesNotExist) {
  const RealtimeRights rights = ask({.name = "pin", .cpu = 100'000}, [] {});
  EXPECT_FALSE(rights.pinned);
  ASSERT_EQ(rights.lacks.size(), 1u);
  EXPECT_NE(rights.lacks[0].find("processor 100000"), std::string::npos) << rights.lacks[0];
}

TEST(RealtimeRights, PrefaultTheStackOfAnyThread) {
  const RealtimeRights rights = ask({.name = "stack"}, [] {});
  EXPECT_TRUE(rights.stack_prefaulted);
  EXPECT_FALSE(rights.degraded());
}

TEST(RealtimeRights, SayThatMemoryIsLockedExactlyWhereTheKernelDoes) {
  const RealtimeRights rights = lock_process_memory();
  EXPECT_EQ(rights.memory_locked, locked_kib() > 0);
  EXPECT_EQ(rights.degraded(), !rights.memory_locked);
  unlock_process_memory();
  EXPECT_EQ(locked_kib(), 0u);
}

}  // namespace
}  // namespace orcart
