// Why a frame, or the capture that waited for it, cannot be painted.
#pragma once

#include <cstdint>
#include <string_view>

namespace orcart {

enum class Refusal : std::uint8_t {
  none,
  no_pose,          ///< the samples around its mid-exposure are too far apart
  tool_unseen,      ///< there are samples around it, but scope or reference was not seen in them
  turn_unknown,     ///< scope and reference were seen, but nothing tells how far the light post is turned
  turn_mismatch,    ///< the pictures' notch says another turn
  too_late,         ///< the samples after it did not come within the longest wait
  queue_full,       ///< as many frames wait for their pose as may
  stamp_in_future,  ///< the driver stamped it after it was dequeued
  stamp_backwards,  ///< the driver stamped it before its predecessor
  no_frame,         ///< of a capture: no frame came in its time
  blocked,          ///< of a capture: the passport forbids painting
};

constexpr std::string_view word_for(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return "none";
    case Refusal::no_pose:
      return "no pose";
    case Refusal::tool_unseen:
      return "tool not seen";
    case Refusal::turn_unknown:
      return "turn of the scope not known";
    case Refusal::turn_mismatch:
      return "turn and notch disagree";
    case Refusal::too_late:
      return "pose too late";
    case Refusal::queue_full:
      return "too many frames waiting";
    case Refusal::stamp_in_future:
      return "frame from the future";
    case Refusal::stamp_backwards:
      return "frame stamps run backwards";
    case Refusal::no_frame:
      return "no frame";
    case Refusal::blocked:
      return "painting blocked";
  }
  return "unknown";
}

}  // namespace orcart
