// The guards' own count of the calling thread's heap calls.
#include "tools/bench/heap_calls.hpp"

#include "tools/guards/thread_guard.hpp"

namespace orcart {

std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept {
  return guards::heap_calls_of_this_thread();
}

}  // namespace orcart
