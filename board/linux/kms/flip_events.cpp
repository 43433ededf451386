// struct drm_event and struct drm_event_vblank, as linux/drm.h has them.
#include "board/linux/kms/flip_events.hpp"

#include <drm.h>

#include <algorithm>
#include <cstring>

namespace orcart {

std::optional<FlipEvent> take_flip_event(std::span<const std::byte>& bytes) noexcept {
  drm_event head{};
  if (bytes.size() < sizeof head) {
    bytes = {};
    return std::nullopt;
  }
  std::memcpy(&head, bytes.data(), sizeof head);
  const std::size_t length = head.length;
  const bool whole = length >= sizeof head && length <= bytes.size();
  drm_event_vblank flip{};
  const bool is_flip = whole && head.type == DRM_EVENT_FLIP_COMPLETE && length >= sizeof flip;
  if (is_flip) std::memcpy(&flip, bytes.data(), sizeof flip);
  bytes = whole ? bytes.subspan(length) : std::span<const std::byte>{};
  if (!is_flip) return std::nullopt;
  return FlipEvent{.serial = flip.user_data,
                   .at = instant_from_nanos(std::int64_t{flip.tv_sec} * 1'000'000'000 +
                                            std::int64_t{flip.tv_usec} * 1000)};
}

}  // namespace orcart
