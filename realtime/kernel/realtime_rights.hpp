// Asks the system for what real-time threads need, and says in plain sentences what it did not get.
#pragma once

#include <string>
#include <vector>

#include "realtime/kernel/thread_spec.hpp"

namespace orcart {

/// What was granted. A flag is set only where the system was asked afterwards and agreed.
struct RealtimeRights {
  bool memory_locked = false;     ///< the process's memory, present and future
  bool fifo = false;              ///< the thread runs under SCHED_FIFO at its priority
  bool pinned = false;            ///< the thread stays on its processor
  bool stack_prefaulted = false;  ///< every page of the thread's stack has been touched
  /// One sentence for each thing that was asked for and refused: what, why it matters, what would help.
  std::vector<std::string> lacks{};

  bool degraded() const { return !lacks.empty(); }
};

/// Locks the whole process's memory, once, before threads start; they must have explicit stacks (ThreadSpec).
/// Asks only where no RLIMIT_MEMLOCK can make later allocations fail; else nothing is locked and the lack is
/// stated.
RealtimeRights lock_process_memory();

/// Gives memory back to the pager.
void unlock_process_memory() noexcept;

/// For the calling thread: name, stack, processor, priority and the finest timers. Once, before its loop;
/// allocates.
RealtimeRights acquire_thread_rights(const ThreadSpec& spec);

}  // namespace orcart
