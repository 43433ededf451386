// Asks a V4L2 device what it is and what it offers, and sets what is wanted: format, rate, controls. Not
// real-time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "board/linux/v4l2/camera_offer.hpp"
#include "board/linux/v4l2/field_view.hpp"
#include "board/ports/port_fault.hpp"

namespace orcart {

/// What a device can be told, e.g. its exposure. `name` in small letters with underscores, as v4l2-ctl has
/// it.
struct CameraControl {
  std::string name;
  std::uint32_t id = 0;
  std::int64_t min = 0, max = 0, step = 1, value = 0;
};

/// What the device agreed to.
struct CameraAgreement {
  std::uint32_t wire_width_px = 0, wire_height_px = 0;
  std::uint32_t stride_bytes = 0, image_bytes = 0;
  FieldLayout layout = FieldLayout::whole;
  double rate_hz = 0;
};

/// Why a node could not be opened: a fault for the program, a sentence for the person.
struct CameraTrouble {
  PortFault fault = PortFault::io;
  std::string sentence;
  bool captures = false;  ///< it is a camera, only none that can be read
};

/// Opens a node and makes sure that it captures video in one plane. Absent, busy, without permission or
/// something else than a camera: refused with the one thing to do.
Result<OpenDevice, CameraTrouble> open_camera_node(DeviceCalls& calls, const std::string& device);
std::string driver_of(const OpenDevice& device);
CameraOffer offer_of(const OpenDevice& device);
std::vector<CameraControl> controls_of(const OpenDevice& device);

/// Sets timings (where the input has any), format, field and rate, and refuses what came out different.
Result<CameraAgreement, CameraTrouble> agree(const OpenDevice& device, const CameraWish& wish);
/// Sets every control of the wish; an unknown name is refused with the names there are, a value out of range
/// with the range.
Result<void, CameraTrouble> set_controls(const OpenDevice& device, const CameraWish& wish);

}  // namespace orcart
