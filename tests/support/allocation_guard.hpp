// Counts what a stretch of code on one thread asks of the heap and of locks: the proof that a step asks
// nothing.
#pragma once

#include <cstdint>
#include <string>

#include "tools/guards/thread_guard.hpp"

namespace orcart::testing {

/// False under ASan and TSan, which bring a malloc of their own: there every count stays 0, and a test that
/// needs the guard to bite skips.
constexpr bool kAllocationGuardWorks = guards::kGuardsWork;

struct HeapAndLockCounts {
  std::uint64_t allocations =
      0;                    ///< malloc, calloc, realloc, aligned forms; operator new comes through malloc
  std::uint64_t frees = 0;  ///< of non-null pointers
  std::uint64_t locks = 0;  ///< pthread_mutex_lock and trylock
};

/// While it lives, counts the calls of the thread that made it. Other threads are not looked at. Does not
/// nest.
class NoAllocationScope {
 public:
  NoAllocationScope() noexcept;
  ~NoAllocationScope() = default;
  NoAllocationScope(const NoAllocationScope&) = delete;
  NoAllocationScope& operator=(const NoAllocationScope&) = delete;

  HeapAndLockCounts counts() const noexcept;
  /// Ends the counting; the counts and the caller stay readable.
  void disarm() noexcept { guard_.disarm(); }
  /// Who called first, one stack frame a line; empty where nobody did. Disarms.
  std::string first_caller();

 private:
  guards::ThreadGuard guard_;
};

}  // namespace orcart::testing
