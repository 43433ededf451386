// Heap and locks alone, of the guards that `orcart latency` uses too.
#include "tests/support/allocation_guard.hpp"

namespace orcart::testing {
namespace {

/// Made once: looking at the loader's list takes longer than most steps.
const guards::CodeMap& code() {
  static const guards::CodeMap map;
  return map;
}

}  // namespace

NoAllocationScope::NoAllocationScope() noexcept : guard_("test", code()) {
  guard_.arm({}, true);
}

HeapAndLockCounts NoAllocationScope::counts() const noexcept {
  return {.allocations = guard_.all(guards::Ask::allocation),
          .frees = guard_.all(guards::Ask::free),
          .locks = guard_.all(guards::Ask::lock)};
}

std::string NoAllocationScope::first_caller() {
  disarm();
  const guards::Finding* const first = guard_.first();
  return first != nullptr ? guards::words_for(first->frames()) : "";
}

}  // namespace orcart::testing
