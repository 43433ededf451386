// The binary reply to BX2: components inside a frame inside components.
#include "firmware-host/tracker/ndi/byte_cursor.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"

namespace orcart::ndi {
namespace {

constexpr std::size_t kComponentHeaderBytes = 12;
constexpr std::uint16_t kFrame = 1, kSixD = 2, kAlerts = 0x12;
constexpr std::size_t kStampBytes = 8;
constexpr std::uint16_t kMissingBit = 0x0100;

struct Component {
  std::uint16_t type = 0;
  std::uint32_t items = 0;
  std::span<const std::byte> content;
};

/// False where the component does not fit what is there.
bool next_component(ByteCursor& cursor, Component& component) noexcept {
  component.type = cursor.u16();
  const std::size_t size = cursor.u32();
  cursor.skip(2);  // the items' option
  component.items = cursor.u32();
  if (!cursor.ok() || size < kComponentHeaderBytes) return false;
  component.content = cursor.take(size - kComponentHeaderBytes);
  return cursor.ok();
}

/// Port status as BX would have it: BX2 sends a code instead.
std::uint32_t port_status_of(std::uint8_t code) noexcept {
  switch (code) {
    case kToolUnplugged:
      return 0;
    case kTrackingNotEnabled:
      return kToolInPort | kPortInitialised;
    case kToolOutOfVolume:
      return kPortReady | kOutOfVolume;
    case kToolPartlyInView:
      return kPortReady | kPartlyInVolume;
    default:
      return kPortReady;
  }
}

void read_tool(ByteCursor& cursor, std::uint32_t frame, HandleReading& reading) noexcept {
  const std::uint16_t status = cursor.u16();
  reading.tool_code = static_cast<std::uint8_t>(status & 0xFFu);
  reading.port_status = port_status_of(reading.tool_code);
  reading.frame = frame;
  if ((status & kMissingBit) != 0) {
    const bool absent = reading.tool_code == kToolUnplugged || reading.tool_code == kTrackingNotEnabled;
    reading.status = absent ? HandleStatus::disabled : HandleStatus::missing;
    return;
  }
  reading.status = HandleStatus::valid;
  reading.has_transform = true;
  for (float& part : reading.quaternion) part = cursor.f32();
  for (float& part : reading.translation_mm) part = cursor.f32();
  reading.error_mm = cursor.f32();
}

std::optional<ReplyFault> read_tools(const Component& component, std::uint32_t frame,
                                     TrackingReply& reply) noexcept {
  ByteCursor cursor(component.content);
  for (std::uint32_t i = 0; i < component.items; ++i) {
    if (reply.count == TrackingReply::kMaxHandles) return ReplyFault::too_many_handles;
    const std::uint16_t handle = cursor.u16();
    if (handle > 0xFF) return ReplyFault::bad_number;
    HandleReading& reading = reply.handles[reply.count++];
    reading.handle = static_cast<std::uint8_t>(handle);
    read_tool(cursor, frame, reading);
    if (!cursor.ok()) return ReplyFault::truncated;
  }
  return std::nullopt;
}

void read_alerts(const Component& component, TrackingReply& reply) noexcept {
  ByteCursor cursor(component.content);
  for (std::uint32_t i = 0; i < component.items && cursor.left() >= 4; ++i) {
    const std::uint8_t kind = cursor.u8();
    cursor.skip(1);
    note_alert(reply.alerts, kind, cursor.u16());
  }
}

/// The components behind a version and their count; `frame` is that of the frame they are in. Frames hold no
/// frames.
std::optional<ReplyFault> read_frame_parts(ByteCursor& cursor, std::uint32_t frame,
                                           TrackingReply& reply) noexcept {
  cursor.skip(2);  // version
  const std::uint16_t count = cursor.u16();
  for (std::uint16_t i = 0; i < count; ++i) {
    Component component;
    if (!next_component(cursor, component)) return ReplyFault::truncated;
    if (component.type == kAlerts) read_alerts(component, reply);
    if (component.type != kSixD) continue;
    if (const auto fault = read_tools(component, frame, reply)) return fault;
  }
  return std::nullopt;
}

std::optional<ReplyFault> read_frames(const Component& component, TrackingReply& reply) noexcept {
  ByteCursor cursor(component.content);
  for (std::uint32_t i = 0; i < component.items; ++i) {
    cursor.skip(4);  // kind of frame, sequence, status
    const std::uint32_t frame = cursor.u32();
    cursor.skip(kStampBytes);
    if (!cursor.ok()) return ReplyFault::truncated;
    reply.has_frame = true;
    if (const auto fault = read_frame_parts(cursor, frame, reply)) return fault;
  }
  return std::nullopt;
}

}  // namespace

Result<TrackingReply, ReplyFault> parse_bx2(std::span<const std::byte> body) noexcept {
  ByteCursor cursor(body);
  TrackingReply reply;
  reply.has_frame = false;
  cursor.skip(2);  // version
  const std::uint16_t count = cursor.u16();
  if (!cursor.ok()) return tl::unexpected(ReplyFault::truncated);
  for (std::uint16_t i = 0; i < count; ++i) {
    Component component;
    if (!next_component(cursor, component)) return tl::unexpected(ReplyFault::truncated);
    if (component.type == kAlerts) read_alerts(component, reply);
    if (component.type != kFrame) continue;
    if (const auto fault = read_frames(component, reply)) return tl::unexpected(*fault);
  }
  if (cursor.left() != 0) return tl::unexpected(ReplyFault::trailing);
  return reply;
}

}  // namespace orcart::ndi
