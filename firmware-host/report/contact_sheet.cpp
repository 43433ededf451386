// Area-filtered thumbnails in a grid on a dark ground.
#include "firmware-host/report/contact_sheet.hpp"

#include <algorithm>

namespace orcart {
namespace {

/// Averages the source pixels that each smaller pixel covers.
Picture shrunk(const Picture& from, int width_px) {
  const int height_px = std::max(1, from.height_px * width_px / std::max(from.width_px, 1));
  Picture to{.width_px = width_px, .height_px = height_px, .rgba = {}};
  to.rgba.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4);
  for (int y = 0; y < height_px; ++y) {
    const int y0 = y * from.height_px / height_px,
              y1 = std::max(y0 + 1, (y + 1) * from.height_px / height_px);
    for (int x = 0; x < width_px; ++x) {
      const int x0 = x * from.width_px / width_px, x1 = std::max(x0 + 1, (x + 1) * from.width_px / width_px);
      unsigned sum[4] = {};
      for (int sy = y0; sy < y1; ++sy) {
        const std::uint8_t* row =
            from.rgba.data() + 4 * (static_cast<std::size_t>(sy) * static_cast<std::size_t>(from.width_px));
        for (int sx = x0; sx < x1; ++sx)
          for (int c = 0; c < 4; ++c) sum[c] += row[4 * sx + c];
      }
      const auto count = static_cast<unsigned>((y1 - y0) * (x1 - x0));
      std::uint8_t* out =
          to.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                                static_cast<std::size_t>(x));
      for (int c = 0; c < 4; ++c) out[c] = static_cast<std::uint8_t>(sum[c] / count);
    }
  }
  return to;
}

void paste(const Picture& from, Picture& onto, int left, int top) {
  for (int y = 0; y < from.height_px; ++y) {
    const auto bytes = static_cast<std::size_t>(from.width_px) * 4;
    std::copy_n(
        from.rgba.data() + static_cast<std::size_t>(y) * bytes, bytes,
        onto.rgba.data() + 4 * (static_cast<std::size_t>(top + y) * static_cast<std::size_t>(onto.width_px) +
                                static_cast<std::size_t>(left)));
  }
}

}  // namespace

Picture contact_sheet(const std::vector<Picture>& pictures, const SheetLayout& layout) {
  Picture sheet;
  if (pictures.empty()) return sheet;
  std::vector<Picture> thumbs;
  thumbs.reserve(pictures.size());
  for (const Picture& p : pictures) thumbs.push_back(shrunk(p, layout.thumb_width_px));

  const auto columns =
      static_cast<std::size_t>(std::min<int>(layout.columns, static_cast<int>(thumbs.size())));
  std::vector<int> row_top{layout.gap_px};
  for (std::size_t first = 0; first < thumbs.size(); first += columns) {
    int highest = 0;
    for (std::size_t i = first; i < std::min(first + columns, thumbs.size()); ++i)
      highest = std::max(highest, thumbs[i].height_px);
    row_top.push_back(row_top.back() + highest + layout.gap_px);
  }
  sheet.width_px = static_cast<int>(columns) * (layout.thumb_width_px + layout.gap_px) + layout.gap_px;
  sheet.height_px = row_top.back();
  sheet.rgba.resize(static_cast<std::size_t>(sheet.width_px) * static_cast<std::size_t>(sheet.height_px) * 4);
  for (std::size_t i = 0; i < sheet.rgba.size(); i += 4) {
    sheet.rgba[i] = sheet.rgba[i + 1] = sheet.rgba[i + 2] = 24;
    sheet.rgba[i + 3] = 255;
  }
  for (std::size_t i = 0; i < thumbs.size(); ++i) {
    paste(thumbs[i], sheet,
          layout.gap_px + static_cast<int>(i % columns) * (layout.thumb_width_px + layout.gap_px),
          row_top[i / columns]);
  }
  return sheet;
}

}  // namespace orcart
