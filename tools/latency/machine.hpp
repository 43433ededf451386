// What a machine shows of itself that costs it latency, each with its remedy.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orcart {

struct Cause {
  std::string what;
  std::string remedy;
};

struct MachineFacts {
  std::string name;  ///< processor, cores, kernel
  bool preempt_rt = false;
  bool fifo = false;         ///< this process may run threads under SCHED_FIFO
  bool memory_lock = false;  ///< this process may lock its memory
  std::vector<Cause> causes;
  /// Wall-clock budgets gate only here.
  bool judged() const { return preempt_rt && fifo; }
};

/// Reads `root`/sys and `root`/proc (a test's own folder, or "/"), and asks for a real-time thread.
MachineFacts look_at_machine(const std::filesystem::path& root = "/");

}  // namespace orcart
