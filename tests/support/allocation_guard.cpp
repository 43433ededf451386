// The per-thread counters behind NoAllocationScope, and the first caller's stack.
#include "tests/support/allocation_guard.hpp"

#include <cstdlib>

#include <execinfo.h>

namespace orcart::testing {
namespace {

struct ThreadState {
  bool armed = false;
  HeapAndLockCounts counts;
  std::array<void*, 24> stack;
  int depth = 0;
};

// Initial-exec: the dynamic model may allocate at a thread's first touch, inside malloc.
[[gnu::tls_model("initial-exec")]] thread_local constinit ThreadState state{};

}  // namespace

void guard::note(Call call) noexcept {
  if (!state.armed) return;
  state.armed = false;  // whatever backtrace() itself does is not counted
  std::uint32_t* const count = call == Call::allocation ? &state.counts.allocations
                               : call == Call::free     ? &state.counts.frees
                                                        : &state.counts.locks;
  ++*count;
  if (state.depth == 0) state.depth = backtrace(state.stack.data(), static_cast<int>(state.stack.size()));
  state.armed = true;
}

NoAllocationScope::NoAllocationScope() noexcept {
  state.depth = backtrace(state.stack.data(), 2);  // its first call loads libgcc, which allocates
  state.depth = 0;
  state.counts = {};
  state.armed = true;
}

NoAllocationScope::~NoAllocationScope() {
  disarm();
}

HeapAndLockCounts NoAllocationScope::counts() const noexcept {
  return state.counts;
}

void NoAllocationScope::disarm() noexcept {
  state.armed = false;
}

std::string NoAllocationScope::first_caller() {
  disarm();
  std::string text;
  char** const lines = backtrace_symbols(state.stack.data(), state.depth);
  for (int i = 1; lines != nullptr && i < state.depth; ++i) text += std::string("  ") + lines[i] + "\n";
  std::free(lines);
  return text;
}

}  // namespace orcart::testing
