// Pictures in and out: PNG and JPEG are read as RGBA, PNG is written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

struct Picture {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba;  ///< row 0 on top

  ImageDescriptor descriptor();
};

Result<Picture> read_picture(const std::filesystem::path& file);
/// Writes beside and renames: never half a file. Alpha is dropped where keep_alpha is Alpha::drop.
enum class Alpha { keep, drop };
Result<void> write_png(const std::filesystem::path& file, int width_px, int height_px,
                       std::span<const std::uint8_t> rgba, Alpha alpha = Alpha::drop);

}  // namespace orcart
