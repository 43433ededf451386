// Counters that one thread writes and others read: load and store need not be one step. Relaxed, without a
// partner: a count alone.
#pragma once

#include <atomic>
#include <type_traits>

namespace orcart {

template <class Number>
void add_alone(std::atomic<Number>& to, std::type_identity_t<Number> what) noexcept {
  to.store(to.load(std::memory_order_relaxed) + what, std::memory_order_relaxed);
}

}  // namespace orcart
