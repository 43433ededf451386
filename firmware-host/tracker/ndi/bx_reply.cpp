// The binary reply to BX.
#include "firmware-host/tracker/ndi/byte_cursor.hpp"
#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"

namespace orcart::ndi {
namespace {

constexpr std::size_t kPositionBytes = 12;
constexpr std::size_t kToolInformationBytes = 11;

/// A count, one out-of-volume bit for each, and that many positions.
void skip_positions(ByteCursor& cursor) noexcept {
  const std::size_t count = cursor.u8();
  cursor.skip((count + 7) / 8 + count * kPositionBytes);
}

void skip_extras(ByteCursor& cursor, std::uint16_t options) noexcept {
  if ((options & kToolInformation) != 0) cursor.skip(kToolInformationBytes);
  if ((options & kSingleStray) != 0 && cursor.u8() != 0) cursor.skip(kPositionBytes);
  if ((options & kMarkerPositions) != 0) skip_positions(cursor);
}

void read_transform(ByteCursor& cursor, HandleReading& reading) noexcept {
  if (reading.status == HandleStatus::valid) {
    reading.has_transform = true;
    for (float& part : reading.quaternion) part = cursor.f32();
    for (float& part : reading.translation_mm) part = cursor.f32();
    reading.error_mm = cursor.f32();
  }
  reading.port_status = cursor.u32();
  reading.frame = cursor.u32();
}

bool is_status(std::uint8_t value) noexcept {
  return value == 1 || value == 2 || value == 4;
}

/// False where the status does not exist. A disabled handle has nothing behind its status.
bool read_handle(ByteCursor& cursor, std::uint16_t options, HandleReading& reading) noexcept {
  reading.handle = cursor.u8();
  const std::uint8_t status = cursor.u8();
  if (!cursor.ok()) return true;
  if (!is_status(status)) return false;
  reading.status = static_cast<HandleStatus>(status);
  if (reading.status == HandleStatus::disabled) return true;
  if ((options & kTransforms) != 0) read_transform(cursor, reading);
  skip_extras(cursor, options);
  return true;
}

}  // namespace

Result<TrackingReply, ReplyFault> parse_bx(std::span<const std::byte> body, std::uint16_t options) noexcept {
  ByteCursor cursor(body);
  TrackingReply reply;
  reply.count = cursor.u8();
  if (reply.count > TrackingReply::kMaxHandles) return tl::unexpected(ReplyFault::too_many_handles);
  for (std::size_t i = 0; i < reply.count; ++i) {
    if (!read_handle(cursor, options, reply.handles[i])) return tl::unexpected(ReplyFault::bad_number);
  }
  if ((options & kPassiveStrays) != 0) skip_positions(cursor);
  reply.system_status = cursor.u16();
  if (!cursor.ok()) return tl::unexpected(ReplyFault::truncated);
  if (cursor.left() != 0) return tl::unexpected(ReplyFault::trailing);
  return reply;
}

}  // namespace orcart::ndi
