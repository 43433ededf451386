// Finds one reply in the bytes that have come.
#include "firmware-host/tracker/ndi/framing.hpp"

#include <algorithm>

#include "firmware-host/tracker/ndi/byte_cursor.hpp"
#include "firmware-host/tracker/ndi/hex.hpp"
#include "realtime/base/crc16.hpp"

namespace orcart::ndi {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::byte kShort{0xC4}, kExtended{0xC8};
constexpr std::byte kStart1{0xA5};

std::uint16_t word_at(Bytes bytes, std::size_t at) noexcept {
  return ByteCursor{bytes.subspan(at, 2)}.u16();
}

/// Whether the text so far may become an answer to a binary command.
bool may_be_text(Bytes bytes) noexcept {
  constexpr std::string_view kError = "ERROR";
  constexpr std::string_view kReset = "RESET";
  const std::size_t n = std::min(bytes.size(), kError.size());
  const std::string_view text{reinterpret_cast<const char*>(bytes.data()), n};
  return n > 0 && (kError.starts_with(text) || kReset.starts_with(text));
}

/// Two bytes of length behind C4 A5, four behind C8 A5; then the header's CRC.
std::size_t header_bytes(std::byte first) noexcept {
  return first == kExtended ? kBinaryHeaderBytes + 2 : kBinaryHeaderBytes;
}

/// The body behind a good header of `header` bytes that starts at `at`.
ReplyFrame body_at(Bytes bytes, std::size_t at, std::size_t header, std::size_t longest) noexcept {
  ReplyFrame frame{.kind = ReplyKind::binary, .skipped = at};
  ByteCursor size(bytes.subspan(at + 2));
  const std::size_t length = header == kBinaryHeaderBytes ? size.u16() : size.u32();
  const std::size_t body = at + header;
  if (length + header + 2 > longest) {
    frame.status = FrameStatus::garbage;
    return frame;
  }
  if (bytes.size() < body + length + 2) return frame;
  frame.payload = bytes.subspan(body, length);
  frame.consumed = body + length + 2;
  const bool good = crc16(frame.payload) == word_at(bytes, body + length);
  frame.status = good ? FrameStatus::complete : FrameStatus::bad_crc;
  return frame;
}

}  // namespace

ReplyFrame find_ascii_reply(Bytes bytes) noexcept {
  ReplyFrame frame{.kind = ReplyKind::ascii};
  const Bytes window = bytes.first(std::min(bytes.size(), kMaxAsciiReplyBytes));
  const auto end = std::find(window.begin(), window.end(), std::byte{'\r'});
  if (end == window.end()) {
    frame.status = bytes.size() > kMaxAsciiReplyBytes ? FrameStatus::garbage : FrameStatus::incomplete;
    return frame;
  }
  const auto size = static_cast<std::size_t>(end - window.begin());
  frame.consumed = size + 1;
  frame.status = FrameStatus::bad_crc;
  if (size < 4) return frame;
  frame.payload = bytes.first(size - 4);
  const std::string_view digits{reinterpret_cast<const char*>(bytes.data()) + size - 4, 4};
  const auto stated = parse_hex(digits);
  if (stated && *stated == crc16(frame.payload)) frame.status = FrameStatus::complete;
  return frame;
}

std::size_t binary_header_bytes(Bytes bytes) noexcept {
  const bool starts =
      bytes.size() >= 2 && (bytes[0] == kShort || bytes[0] == kExtended) && bytes[1] == kStart1;
  return starts ? header_bytes(bytes[0]) : 0;
}

ReplyFrame find_binary_reply(Bytes bytes, std::size_t longest) noexcept {
  if (may_be_text(bytes)) return find_ascii_reply(bytes);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (bytes[at] != kShort && bytes[at] != kExtended) continue;
    const Bytes rest = bytes.subspan(at);
    if (rest.size() >= 2 && rest[1] != kStart1) continue;
    const std::size_t header = header_bytes(rest[0]);
    if (rest.size() < header) return {.kind = ReplyKind::binary, .skipped = at};
    if (crc16(rest.first(header - 2)) == word_at(rest, header - 2))
      return body_at(bytes, at, header, longest);
    if (at == 0) return {.status = FrameStatus::bad_crc, .kind = ReplyKind::binary, .consumed = bytes.size()};
  }
  const FrameStatus status = bytes.empty() ? FrameStatus::incomplete : FrameStatus::garbage;
  return {.status = status, .kind = ReplyKind::binary, .skipped = bytes.size()};
}

}  // namespace orcart::ndi
