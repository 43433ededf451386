// Writes any picture the board knows as a PNG, for people to look at.
#pragma once

#include <filesystem>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Red green blue bytes of a CPU picture (yuyv, nv12, rgba8888, xrgb8888 or gray8), row by row; empty for
/// others.
std::vector<std::uint8_t> rgb_of(const ImageDescriptor& image);

/// Written beside and renamed: never half a file.
Result<void> write_picture_png(const std::filesystem::path& file, const ImageDescriptor& image);

}  // namespace orcart
