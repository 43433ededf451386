// The verdict of the allocation guard in words.
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {

::testing::AssertionResult asked_nothing(NoAllocationScope& scope) {
  scope.disarm();
  const HeapAndLockCounts counts = scope.counts();
  if (counts.allocations + counts.frees + counts.locks == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << counts.allocations << " allocations, " << counts.frees
                                       << " frees and " << counts.locks << " locks, the first from\n"
                                       << scope.first_caller();
}

}  // namespace orcart::testing
