// Opens the camera that cart.toml names: the one place where a kind of camera becomes a FrameSource.
#pragma once

#include <memory>

#include "board/ports/frame_source.hpp"
#include "firmware-host/app/device_config.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Null for the simulated camera, which is made together with the rest of the simulated cart. Refused in a
/// sentence with the remedy, also where the driver's stamps cannot mean what is configured. `clock` outlives
/// the camera.
Result<std::unique_ptr<FrameSource>> open_camera(const CameraConfig& camera, Clock& clock);

}  // namespace orcart
