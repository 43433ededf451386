// Counts what a stretch of code on one thread asks of the heap and of locks: the proof that a step asks
// nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace orcart::testing {

/// False under ASan and TSan, which bring a malloc of their own: there every count stays 0, and a test that
/// needs the guard to bite skips.
constexpr bool kAllocationGuardWorks = ORCART_ALLOCATION_GUARD != 0;

struct HeapAndLockCounts {
  std::uint32_t allocations =
      0;                    ///< malloc, calloc, realloc, aligned forms; operator new comes through malloc
  std::uint32_t frees = 0;  ///< of non-null pointers
  std::uint32_t locks = 0;  ///< pthread_mutex_lock and trylock
};

/// While it lives, counts the calls of the thread that made it. Other threads are not looked at. Does not
/// nest.
class NoAllocationScope {
 public:
  NoAllocationScope() noexcept;
  ~NoAllocationScope();
  NoAllocationScope(const NoAllocationScope&) = delete;
  NoAllocationScope& operator=(const NoAllocationScope&) = delete;

  HeapAndLockCounts counts() const noexcept;
  /// Ends the counting; the counts and the caller stay readable.
  void disarm() noexcept;
  /// Who called first, one stack frame a line; empty where nobody did. Disarms.
  std::string first_caller();
};

/// What the interposed functions report. For tests/support alone.
namespace guard {
enum class Call : std::uint8_t { allocation, free, lock };
void note(Call call) noexcept;
}  // namespace guard

}  // namespace orcart::testing
