// One camera picture on its way: a loan from the camera's pool with the instants that matter, named once.
#pragma once

#include <cstdint>
#include <optional>

#include "realtime/base/image.hpp"
#include "realtime/base/instant.hpp"

namespace orcart {

struct CapturedFrame {
  std::uint32_t buffer = 0;    ///< the loan: goes home by the return lane, exactly once
  std::uint32_t sequence = 0;  ///< the driver's count
  ImageDescriptor image;
  Instant exposure_start{};
  Instant exposure_end{};
  Instant dequeued_at{};
  std::optional<double> notch_turn_rad;  ///< by the picture's notch; nothing: not looked for, or not known

  Instant mid_exposure() const { return exposure_start + (exposure_end - exposure_start) / 2; }
};

/// The pedal asked for a picture: the first good frame whose mid-exposure is not before `edge_at`.
struct CaptureRequest {
  std::uint32_t unit = 0;  ///< undo unit; a stream of pictures shares one
  Instant edge_at{};       ///< the kernel's stamp of the pedal edge
  bool streaming = false;  ///< one of a stream: every frame until the release
};

}  // namespace orcart
