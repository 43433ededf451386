// A picture's bytes on their way to disk and back: packed tightly, then deflated without loss.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Copies the rows without their padding; returns the bytes written, or 0 where the pixels are not in this
/// process's memory, the format is none or they do not fit. Real-time: one copy, nothing else.
std::size_t copy_packed(const ImageDescriptor& image, std::span<std::byte> into) noexcept;

/// How pictures are kept: each byte less the one four before it (the same part of a neighbouring pixel, in
/// every format), then Huffman-coded in zlib's format (RFC 1950), whose checksum comes with it. Half the time
/// of plain deflate on a noisy picture, and smaller.
inline constexpr std::string_view kPictureEncoding = "sub4+deflate";

/// Off the real-time path. The result lies in `buffer`.
std::span<const std::byte> deflated(std::span<const std::byte> bytes, std::vector<std::byte>& buffer);
/// Refuses what does not unfold to exactly `size_bytes`.
Result<std::vector<std::byte>> inflated(std::span<const std::byte> bytes, std::size_t size_bytes);

}  // namespace orcart
