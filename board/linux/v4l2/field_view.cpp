// Strides and offsets of fields.
#include "board/linux/v4l2/field_view.hpp"

namespace orcart {
namespace {

bool is_woven(FieldLayout layout) {
  return layout == FieldLayout::woven_top_first || layout == FieldLayout::woven_bottom_first;
}

bool is_stacked(FieldLayout layout) {
  return layout == FieldLayout::stacked_top_first || layout == FieldLayout::stacked_bottom_first;
}

bool is_older(FieldLayout layout, FieldChoice field) {
  const bool top_first = layout == FieldLayout::woven_top_first || layout == FieldLayout::stacked_top_first;
  return top_first == (field == FieldChoice::top);
}

}  // namespace

ImageDescriptor field_of(const ImageDescriptor& both, FieldLayout layout, FieldChoice field) {
  ImageDescriptor one = both;
  if (!is_woven(layout) && !is_stacked(layout)) return one;
  one.height_px = both.height_px / 2;
  for (int p = 0; p < both.plane_count; ++p) {
    ImagePlane& plane = one.planes[static_cast<std::size_t>(p)];
    const bool chroma = both.format == PixelFormat::nv12 && p == 1;
    const auto rows = static_cast<std::uint32_t>(chroma ? both.height_px / 2 : both.height_px);
    if (is_stacked(layout)) {
      if (!is_older(layout, field)) plane.offset_bytes += rows / 2 * plane.stride_bytes;
    } else {
      if (field == FieldChoice::bottom) plane.offset_bytes += plane.stride_bytes;
      plane.stride_bytes *= 2;
    }
  }
  return one;
}

Nanos field_delay(FieldLayout layout, FieldChoice field, StampedAt stamped, Nanos frame_period) {
  if (!is_woven(layout) && !is_stacked(layout)) return Nanos{0};
  const bool older = is_older(layout, field);
  if (stamped == StampedAt::end_of_frame) return older ? -frame_period / 2 : Nanos{0};
  return older ? Nanos{0} : frame_period / 2;
}

}  // namespace orcart
