// Where a reply begins and ends in the bytes that have come, and whether its CRC holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware-host/tracker/ndi/command.hpp"

namespace orcart::ndi {

enum class FrameStatus : std::uint8_t {
  incomplete,  ///< nothing wrong so far; more bytes are needed
  complete,    ///< one whole reply with a good CRC
  bad_crc,     ///< one whole reply, damaged
  garbage,     ///< no reply can begin here
};

/// The longest replies: what is longer is no reply.
inline constexpr std::size_t kMaxAsciiReplyBytes = 2048;
inline constexpr std::size_t kMaxBinaryReplyBytes = 4096;
inline constexpr std::size_t kBinaryHeaderBytes = 6;

struct ReplyFrame {
  FrameStatus status = FrameStatus::incomplete;
  ReplyKind kind = ReplyKind::ascii;
  std::span<const std::byte> payload;  ///< without header, CRC and carriage return; lent from the input
  std::size_t skipped = 0;             ///< bytes in front that belong to no reply
  std::size_t consumed = 0;            ///< bytes up to the end of the reply, `skipped` included

  std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(payload.data()), payload.size()};
  }
};

/// Text up to the carriage return, its last four letters the CRC. Any bytes are safe.
ReplyFrame find_ascii_reply(std::span<const std::byte> bytes) noexcept;

/// C4 A5, length, header CRC, body, body CRC; or C8 A5 with a length of four bytes, as BX2 may need it. Skips
/// what comes before a header whose own CRC holds. A device answers a binary command with text (ERRORhh,
/// RESET) where it cannot obey; that is found too. Any bytes are safe.
ReplyFrame find_binary_reply(std::span<const std::byte> bytes,
                             std::size_t longest = kMaxBinaryReplyBytes) noexcept;
/// What stands in front of the body; 0 where the bytes begin with no start sequence.
std::size_t binary_header_bytes(std::span<const std::byte> bytes) noexcept;

inline ReplyFrame find_reply(std::span<const std::byte> bytes, ReplyKind kind) noexcept {
  return kind == ReplyKind::ascii ? find_ascii_reply(bytes) : find_binary_reply(bytes);
}

}  // namespace orcart::ndi
