// Enumeration by VIDIOC_ENUM_*; setting by VIDIOC_S_*, always checked against what the driver made of it.
#include "board/linux/v4l2/camera_query.hpp"

#include <fcntl.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "board/linux/byte_stream.hpp"

namespace orcart {
namespace {

constexpr std::uint32_t kMostListed =
    256;  ///< of formats, sizes or rates: a driver that never ends is cut off

tl::unexpected<CameraTrouble> trouble(PortFault fault, std::string sentence) {
  return tl::unexpected(CameraTrouble{fault, std::move(sentence)});
}

std::string text_of_bytes(const std::uint8_t* bytes, std::size_t most) {
  const auto* letters = reinterpret_cast<const char*>(bytes);
  return {letters, strnlen(letters, most)};
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0 : double(interval.denominator) / interval.numerator;
}

std::vector<RateRange> rates_of(const OpenDevice& device, std::uint32_t code, std::uint32_t width,
                                std::uint32_t height) {
  std::vector<RateRange> rates;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_frmivalenum item{.index = i, .pixel_format = code, .width = width, .height = height};
    if (device.control(VIDIOC_ENUM_FRAMEINTERVALS, &item) < 0) break;
    if (item.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.push_back({rate_of(item.discrete), rate_of(item.discrete)});
    } else {
      rates.push_back({rate_of(item.stepwise.max), rate_of(item.stepwise.min)});
      break;
    }
  }
  return rates;
}

int as_int(std::uint32_t value) {
  return static_cast<int>(std::min<std::uint32_t>(value, 1U << 20));
}

void add_sizes(const OpenDevice& device, std::uint32_t code, std::vector<CameraMode>& modes) {
  std::uint32_t i = 0;
  for (; i < kMostListed; ++i) {
    v4l2_frmsizeenum item{.index = i, .pixel_format = code};
    if (device.control(VIDIOC_ENUM_FRAMESIZES, &item) < 0) break;
    if (item.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      const int width = as_int(item.discrete.width), height = as_int(item.discrete.height);
      modes.push_back({code,
                       {width, width, 1},
                       {height, height, 1},
                       rates_of(device, code, item.discrete.width, item.discrete.height)});
      continue;
    }
    const v4l2_frmsize_stepwise& range = item.stepwise;
    modes.push_back(
        {code,
         {as_int(range.min_width), as_int(range.max_width), std::max(1, as_int(range.step_width))},
         {as_int(range.min_height), as_int(range.max_height), std::max(1, as_int(range.step_height))},
         rates_of(device, code, range.max_width, range.max_height)});
    return;
  }
  if (i == 0)
    modes.push_back({code, {0, 0, 1}, {0, 0, 1}, {}});  // e.g. a television input: one size, not told
}

FieldLayout layout_of(std::uint32_t field, std::uint32_t whole_height) {
  const bool sixty_hertz = whole_height == 480 || whole_height == 486;  // its bottom field is the older one
  switch (field) {
    case V4L2_FIELD_INTERLACED:
      return sixty_hertz ? FieldLayout::woven_bottom_first : FieldLayout::woven_top_first;
    case V4L2_FIELD_INTERLACED_TB:
      return FieldLayout::woven_top_first;
    case V4L2_FIELD_INTERLACED_BT:
      return FieldLayout::woven_bottom_first;
    case V4L2_FIELD_SEQ_TB:
      return FieldLayout::stacked_top_first;
    case V4L2_FIELD_SEQ_BT:
      return FieldLayout::stacked_bottom_first;
    case V4L2_FIELD_ALTERNATE:
      return FieldLayout::one_at_a_time;
    default:
      return FieldLayout::whole;
  }
}

v4l2_format ask_format(const OpenDevice& device, const CameraWish& wish, std::uint32_t field, int& error) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(wish.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(wish.height_px) *
                          (wish.field == FieldChoice::progressive || field == V4L2_FIELD_ALTERNATE ? 1 : 2);
  format.fmt.pix.pixelformat = static_cast<std::uint32_t>(wish.format);
  format.fmt.pix.field = field;
  error = device.control(VIDIOC_S_FMT, &format);
  return format;
}

/// Follows the signal of an HDMI or SDI input; others have no timings and say so.
void follow_timings(const OpenDevice& device) {
  v4l2_dv_timings timings{};
  if (device.control(VIDIOC_QUERY_DV_TIMINGS, &timings) == 0)
    (void)device.control(VIDIOC_S_DV_TIMINGS, &timings);
}

double ask_rate(const OpenDevice& device, double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(rate_hz * 1000 + 0.5)};
  if (device.control(VIDIOC_S_PARM, &parameters) < 0 && device.control(VIDIOC_G_PARM, &parameters) < 0)
    return 0;
  return rate_of(parameters.parm.capture.timeperframe);
}

std::string remedy(PortFault fault) {
  switch (fault) {
    case PortFault::no_permission:
      return "; a user in the group video would be let in";
    case PortFault::busy:
      return "; end the program that holds it";
    case PortFault::disconnected:
      return "; plug the camera in, or name another device (orcart probe lists them)";
    default:
      return "; a camera's node such as /dev/video0 would be accepted";
  }
}

}  // namespace

Result<OpenDevice, CameraTrouble> open_camera_node(DeviceCalls& calls, const std::string& device) {
  const int fd = calls.open(device.c_str(), O_RDWR | O_NONBLOCK);
  if (fd < 0) {
    const PortFault fault = port_fault_of(-fd);
    return trouble(fault,
                   "camera " + device + " cannot be opened: " + std::string(word_for(fault)) + remedy(fault));
  }
  OpenDevice node(calls, fd);
  v4l2_capability capability{};
  if (const int answer = node.control(VIDIOC_QUERYCAP, &capability); answer < 0) {
    const PortFault fault = answer == -ENODEV ? PortFault::disconnected : PortFault::unsupported;
    return trouble(fault, device + " is no video device" + remedy(fault));
  }
  const std::uint32_t able = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps
                                                                                   : capability.capabilities;
  const bool one_plane = (able & V4L2_CAP_VIDEO_CAPTURE) != 0;
  if (!one_plane && (able & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0 &&
      (able & V4L2_CAP_VIDEO_OUTPUT_MPLANE) == 0) {  // with an output it is a codec
    return tl::unexpected(CameraTrouble{PortFault::unsupported,
                                        device + " captures in several planes only, which orcart does not "
                                                 "read; a grabber that uvcvideo drives would do",
                                        true});
  }
  if (!one_plane || (able & V4L2_CAP_STREAMING) == 0) {
    return trouble(PortFault::unsupported,
                   device + " does not deliver pictures in one plane by streaming" + remedy(PortFault::io));
  }
  return node;
}

std::string driver_of(const OpenDevice& device) {
  v4l2_capability capability{};
  if (device.control(VIDIOC_QUERYCAP, &capability) < 0) return {};
  return text_of_bytes(capability.driver, sizeof capability.driver);
}

CameraOffer offer_of(const OpenDevice& device) {
  CameraOffer offer;
  v4l2_capability capability{};
  if (device.control(VIDIOC_QUERYCAP, &capability) >= 0)
    offer.card = text_of_bytes(capability.card, sizeof capability.card);
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_fmtdesc item{.index = i, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    if (device.control(VIDIOC_ENUM_FMT, &item) < 0) break;
    add_sizes(device, item.pixelformat, offer.modes);
  }
  return offer;
}

std::vector<CameraControl> controls_of(const OpenDevice& device) {
  std::vector<CameraControl> controls;
  v4l2_queryctrl item{.id = V4L2_CTRL_FLAG_NEXT_CTRL};
  for (std::uint32_t i = 0; i < 4 * kMostListed && device.control(VIDIOC_QUERYCTRL, &item) >= 0; ++i) {
    const bool settable = (item.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_READ_ONLY)) == 0 &&
                          item.type != V4L2_CTRL_TYPE_CTRL_CLASS;
    if (settable) {
      std::string name;
      for (const char letter : text_of_bytes(item.name, sizeof item.name)) {
        if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
          name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        else if (!name.empty() && name.back() != '_')
          name += '_';
      }
      while (!name.empty() && name.back() == '_') name.pop_back();
      v4l2_control value{.id = item.id};
      if (device.control(VIDIOC_G_CTRL, &value) < 0) value.value = item.default_value;
      controls.push_back({name, item.id, item.minimum, item.maximum, item.step, value.value});
    }
    item.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return controls;
}

Result<CameraAgreement, CameraTrouble> agree(const OpenDevice& device, const CameraWish& wish) {
  follow_timings(device);
  const bool progressive = wish.field == FieldChoice::progressive;
  int error = 0;
  v4l2_format format = ask_format(device, wish, progressive ? V4L2_FIELD_NONE : V4L2_FIELD_ALTERNATE, error);
  if (error >= 0 && !progressive && format.fmt.pix.field != V4L2_FIELD_ALTERNATE)
    format = ask_format(device, wish, V4L2_FIELD_INTERLACED, error);
  const std::string camera = "camera " + wish.device;
  if (error == -EBUSY) return trouble(PortFault::busy, camera + " streams to another program; end that one");
  if (error == -ENODEV) return trouble(PortFault::disconnected, camera + " is gone; plug it in again");
  if (error < 0)
    return trouble(PortFault::unsupported,
                   camera + " refuses " + std::string(name_of(wish.format)) + "; see orcart probe");

  const v4l2_pix_format& pix = format.fmt.pix;
  CameraAgreement agreed{.wire_width_px = pix.width,
                         .wire_height_px = pix.height,
                         .stride_bytes = pix.bytesperline,
                         .image_bytes = pix.sizeimage};
  const bool one_field = pix.field == V4L2_FIELD_ALTERNATE;
  agreed.layout = layout_of(pix.field, one_field ? pix.height * 2 : pix.height);
  const bool interlaced = agreed.layout != FieldLayout::whole;
  if (interlaced == progressive) {
    return trouble(PortFault::unsupported,
                   camera +
                       (interlaced ? " delivers interlaced pictures; field = \"top\" or \"bottom\""
                                   : " delivers whole pictures; field = \"progressive\"") +
                       " would be accepted");
  }
  const auto lines = interlaced && !one_field ? pix.height / 2 : pix.height;
  if (pix.pixelformat != static_cast<std::uint32_t>(wish.format) ||
      pix.width != static_cast<std::uint32_t>(wish.width_px) ||
      lines != static_cast<std::uint32_t>(wish.height_px)) {
    return trouble(PortFault::unsupported, camera + " makes " + name_of_code(pix.pixelformat) + " of " +
                                               std::to_string(pix.width) + "x" + std::to_string(lines) +
                                               " out of what was asked; that, or a mode that orcart probe "
                                               "lists, would be accepted");
  }
  agreed.rate_hz = ask_rate(device, wish.rate_hz);
  if (agreed.rate_hz <= 0) agreed.rate_hz = wish.rate_hz;  // the device does not tell; the signal decides
  if (std::max(agreed.rate_hz, wish.rate_hz) >
      (1 + kRateTolerance) * std::min(agreed.rate_hz, wish.rate_hz)) {
    return trouble(PortFault::unsupported, camera + " runs at " + std::to_string(agreed.rate_hz) +
                                               " Hz where rate_hz asks for " + std::to_string(wish.rate_hz) +
                                               "; the former would be accepted");
  }
  return agreed;
}

namespace {

Result<void, CameraTrouble> set_control(const OpenDevice& device, const CameraWish& wish,
                                        const CameraWish::Control& wanted,
                                        const std::vector<CameraControl>& known) {
  const auto found = std::ranges::find(known, wanted.name, &CameraControl::name);
  const std::string camera = "camera " + wish.device;
  if (found == known.end()) {
    std::string names;
    for (const CameraControl& control : known) names += (names.empty() ? "" : ", ") + control.name;
    return trouble(PortFault::unsupported,
                   camera + " has no control \"" + wanted.name + "\"; it has " + names);
  }
  v4l2_control value{.id = found->id, .value = static_cast<std::int32_t>(wanted.value)};
  const bool fits = wanted.value >= found->min && wanted.value <= found->max;
  if (fits && device.control(VIDIOC_S_CTRL, &value) >= 0) return {};
  return trouble(PortFault::unsupported,
                 camera + " refuses " + wanted.name + " = " + std::to_string(wanted.value) + "; " +
                     std::to_string(found->min) + " to " + std::to_string(found->max) + " in steps of " +
                     std::to_string(found->step) + " would be accepted");
}

}  // namespace

// What is refused is tried once more at the end, because one control may unlock another one (exposure after
// auto exposure) and a table has no order.
Result<void, CameraTrouble> set_controls(const OpenDevice& device, const CameraWish& wish) {
  if (wish.controls.empty()) return {};
  const std::vector<CameraControl> known = controls_of(device);
  std::vector<CameraWish::Control> refused;
  for (const CameraWish::Control& wanted : wish.controls)
    if (!set_control(device, wish, wanted, known)) refused.push_back(wanted);
  for (const CameraWish::Control& wanted : refused)
    if (auto set = set_control(device, wish, wanted, known); !set) return set;
  return {};
}

}  // namespace orcart
