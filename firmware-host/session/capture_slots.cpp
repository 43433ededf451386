// One copy on the real-time side; everything slow happens on the other.
#include "firmware-host/session/capture_slots.hpp"

#include "firmware-host/session/picture_bytes.hpp"

namespace orcart {

CaptureSlots::CaptureSlots(std::size_t count, std::size_t picture_bytes)
    : slots_(count), notes_(count + kUndosAhead) {
  for (CaptureSlot& slot : slots_.slots()) slot.pixels.assign(picture_bytes, std::byte{});
}

bool CaptureSlots::offer(const CapturedFrame& frame, const CaptureFacts& facts) noexcept {
  const auto handle = slots_.take();
  if (!handle) return count_lost();
  CaptureSlot& slot = slots_[*handle];
  slot.used_bytes = copy_packed(frame.image, slot.pixels);
  if (slot.used_bytes == 0) {
    slots_.put_back(*handle);
    return count_lost();
  }
  slot.frame = frame;
  slot.frame.image =
      packed_image(slot.pixels.data(), frame.image.format, frame.image.width_px, frame.image.height_px);
  slot.facts = facts;
  if (notes_.try_push({.kind = SessionNote::Kind::captured, .slot = *handle, .unit = facts.unit}))
    return true;
  slots_.put_back(*handle);
  return count_lost();
}

bool CaptureSlots::undone(std::uint32_t unit) noexcept {
  return notes_.try_push({.kind = SessionNote::Kind::undone, .slot = {}, .unit = unit}) || count_lost();
}

std::optional<SessionNote> CaptureSlots::next() noexcept {
  SessionNote note;
  if (!notes_.try_pop(note)) return std::nullopt;
  return note;
}

bool CaptureSlots::count_lost() noexcept {
  // One writer, the real-time thread; a count alone, no partner.
  lost_.store(lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return false;
}

}  // namespace orcart
