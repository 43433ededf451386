// Counts heap calls for benches: malloc and its family, of the asking thread.
#pragma once

#include <cstdint>
#include <optional>

namespace orcart {

/// Calls so far; the difference of two answers counts a stretch of code. Nothing under sanitizers, which
/// bring their own malloc.
std::optional<std::uint64_t> heap_calls_of_this_thread() noexcept;

}  // namespace orcart
