// One branch a kind.
#include "firmware-host/app/open_camera.hpp"

#include "board/linux/v4l2/v4l2_frame_source.hpp"
#include "firmware-host/app/topology.hpp"

namespace orcart {

Result<std::unique_ptr<FrameSource>> open_camera(const CameraConfig& camera, Clock& clock) {
  if (camera.kind == CameraKind::simulated) return std::unique_ptr<FrameSource>{};
  auto opened = V4l2FrameSource::open({.wish = camera.device, .buffers = kFrameBuffers, .clock = clock});
  if (!opened) return tl::unexpected(opened.error());
  V4l2FrameSource& source = **opened;
  if (!source.stamps_are_monotonic() && camera.stamp != StampMeaning::dequeued) {
    return fail("camera " + camera.device.device + " (" + source.card() +
                ") stamps its pictures by no known clock; stamp = \"dequeued\" would be accepted");
  }
  if (source.buffer_count() > kFrameQueueDepth) {
    return fail("camera " + camera.device.device + " insists on " + std::to_string(source.buffer_count()) +
                " buffers; " + std::to_string(kFrameQueueDepth) + " at most are accepted");
  }
  return std::unique_ptr<FrameSource>(std::move(*opened));
}

}  // namespace orcart
