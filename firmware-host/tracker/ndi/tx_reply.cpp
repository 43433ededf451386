// The text reply to TX.
#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/text_cursor.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"

namespace orcart::ndi {
namespace {

constexpr float kQuaternionUnit = 1e-4F;
constexpr float kMillimetreUnit = 1e-2F;
constexpr float kErrorUnit = 1e-4F;
constexpr std::size_t kPositionLetters = 21;

void read_transform(TextCursor& cursor, HandleReading& reading) noexcept {
  reading.has_transform = true;
  for (float& part : reading.quaternion)
    part = static_cast<float>(cursor.signed_decimal(6)) * kQuaternionUnit;
  for (float& part : reading.translation_mm) {
    part = static_cast<float>(cursor.signed_decimal(7)) * kMillimetreUnit;
  }
  reading.error_mm = static_cast<float>(cursor.signed_decimal(6)) * kErrorUnit;
}

/// What follows port status and frame up to the line feed is asked for by other options, and passed over.
void read_handle(TextCursor& cursor, std::uint16_t options, HandleReading& reading) noexcept {
  reading.handle = static_cast<std::uint8_t>(cursor.hex(2));
  reading.status = HandleStatus::valid;  // unless a word says otherwise
  const bool absent = cursor.take_word("DISABLED") || cursor.take_word("UNOCCUPIED");
  if (absent) {
    reading.status = HandleStatus::disabled;
  } else if ((options & kTransforms) != 0) {
    if (cursor.take_word("MISSING")) {
      reading.status = HandleStatus::missing;
    } else {
      read_transform(cursor, reading);
    }
    reading.port_status = cursor.hex(8);
    reading.frame = cursor.hex(8);
  }
  cursor.skip_line();
}

/// A count, a hex digit of out-of-volume bits for each four, and that many positions.
void skip_strays(TextCursor& cursor) noexcept {
  const std::size_t count = cursor.hex(2);
  cursor.take((count + 3) / 4 + count * kPositionLetters);
}

}  // namespace

Result<TrackingReply, ReplyFault> parse_tx(std::string_view text, std::uint16_t options) noexcept {
  TextCursor cursor(text);
  TrackingReply reply;
  reply.count = cursor.hex(2);
  if (reply.count > TrackingReply::kMaxHandles) return tl::unexpected(ReplyFault::too_many_handles);
  for (std::size_t i = 0; i < reply.count; ++i) read_handle(cursor, options, reply.handles[i]);
  if ((options & kPassiveStrays) != 0) skip_strays(cursor);
  reply.system_status = static_cast<std::uint16_t>(cursor.hex(4));
  if (!cursor.ok()) return tl::unexpected(ReplyFault::bad_number);
  if (cursor.left() != 0) return tl::unexpected(ReplyFault::trailing);
  return reply;
}

}  // namespace orcart::ndi
