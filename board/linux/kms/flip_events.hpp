// What the kernel writes into a display card's descriptor when a picture has come onto the panel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "realtime/base/instant.hpp"

namespace orcart {

struct FlipEvent {
  std::uint64_t serial = 0;  ///< the number given to the commit
  Instant at{};              ///< the vblank, on the monotonic clock
};

/// Takes the first event off `bytes`: a flip, or nothing where it is of another kind. Bytes that hold no
/// whole event are dropped. Safe on any bytes.
std::optional<FlipEvent> take_flip_event(std::span<const std::byte>& bytes) noexcept;

}  // namespace orcart
