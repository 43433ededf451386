// One field of an interlaced picture, without a copy: every second line, or one half, with the instant at
// which that field was taken.
#pragma once

#include "board/linux/v4l2/camera_offer.hpp"
#include "realtime/base/instant.hpp"

namespace orcart {

/// How the lines of a buffer lie. `top_first`: the top field is the older one.
enum class FieldLayout : std::uint8_t {
  whole,            ///< progressive
  woven_top_first,  ///< lines of both fields in turn
  woven_bottom_first,
  stacked_top_first,  ///< the older field above the other one
  stacked_bottom_first,
  one_at_a_time,  ///< each buffer is one field, and says which
};

/// The descriptor of one field in a picture of both; `whole` and `one_at_a_time` come back as they are.
ImageDescriptor field_of(const ImageDescriptor& both, FieldLayout layout, FieldChoice field);

enum class StampedAt : std::uint8_t { end_of_frame, start_of_exposure };
/// What to add to a buffer's stamp, so that it belongs to the chosen field: the fields of one buffer are half
/// a frame period apart, a stamp at the end is the younger one's, a stamp at the start the older one's.
Nanos field_delay(FieldLayout layout, FieldChoice field, StampedAt stamped, Nanos frame_period);

}  // namespace orcart
