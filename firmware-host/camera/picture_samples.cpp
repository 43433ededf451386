// Reads luma straight from the camera's bytes; no picture is converted.
#include "firmware-host/camera/picture_samples.hpp"

#include <algorithm>
#include <cstddef>

#include "realtime/base/luma.hpp"

namespace orcart {
namespace {

constexpr int kColumns = 64, kRows = 48;
constexpr std::uint32_t kDark = 24, kBright = 250;

}  // namespace

PictureSamples sample_picture(const ImageDescriptor& image) noexcept {
  const LumaLayout layout = luma_layout(image.format);
  const ImagePlane& plane = image.planes[0];
  if (plane.data == nullptr || layout.step_bytes == 0 || image.width_px <= 0 || image.height_px <= 0)
    return {};

  const int columns = std::min(kColumns, image.width_px), rows = std::min(kRows, image.height_px);
  std::uint32_t hash = 2166136261U, sum = 0, dark = 0, bright = 0;
  for (int r = 0; r < rows; ++r) {
    // Rows and columns are shifted against each other so that no stripe of the picture is missed for good.
    const auto y = static_cast<std::size_t>((r * image.height_px + r % 7) / rows);
    const std::byte* row = plane.data + plane.offset_bytes + y * plane.stride_bytes + layout.first_byte;
    for (int c = 0; c < columns; ++c) {
      const auto x = static_cast<std::size_t>((c * image.width_px + r % columns) / columns);
      const auto luma = static_cast<std::uint32_t>(row[x * layout.step_bytes]);
      hash = (hash ^ luma) * 16777619U;
      sum += luma;
      dark += luma < kDark ? 1 : 0;
      bright += luma > kBright ? 1 : 0;
    }
  }
  const auto count = static_cast<float>(rows * columns);
  return {.known = true,
          .checksum = hash,
          .mean_luma = static_cast<float>(sum) / count,
          .dark_share = static_cast<float>(dark) / count,
          .bright_share = static_cast<float>(bright) / count};
}

}  // namespace orcart
