// A V4L2 driver played behind the seam of system calls: one mode, buffers in this process's memory, faults on
// request.
#pragma once

#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// A name as the kernel writes it, into a field that is longer.
template <std::size_t N>
void put_name(std::uint8_t (&field)[N], std::string_view name) {
  std::copy_n(name.begin(), std::min(name.size(), N - 1), field);
}

class ScriptedCameraDevice final : public DeviceCalls {
 public:
  explicit ScriptedCameraDevice(SimulatedClock& clock) : clock_(clock) {}

  // What the device is.
  std::uint32_t pixel_format = V4L2_PIX_FMT_YUYV, width = 64, height = 48, field = V4L2_FIELD_NONE;
  std::uint32_t stride = 128, image_bytes = 64 * 48 * 2;
  std::uint32_t buffer_limit = 32;
  std::uint32_t rate_hz = 30;
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::uint32_t stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;

  // What goes wrong: the negative error number each call answers with from now on.
  int open_error = 0, dequeue_error = 0, stream_on_error = 0, control_error = 0;
  bool poll_error = false, exports = true, source_change = false;

  /// The driver fills the oldest queued buffer; false where none is queued (the frame is lost all the same).
  bool fill(std::uint32_t bytes, std::uint32_t flags = 0, std::uint32_t of_field = V4L2_FIELD_NONE) {
    const std::uint32_t number = sequence++;
    if (!streaming || queued.empty()) return false;
    filled.push_back({queued.front(), number, bytes, flags, of_field, clock_.now()});
    queued.pop_front();
    return true;
  }
  bool fill() { return fill(image_bytes); }
  /// As v4l2loopback does: fills and hands out a buffer that nobody queued.
  void fill_unqueued(std::uint32_t index) {
    filled.push_back({index, sequence++, image_bytes, 0, V4L2_FIELD_NONE, clock_.now()});
  }
  std::byte* memory(std::uint32_t index) { return buffers[index]->data(); }

  int open(const char*, int) noexcept override {
    if (open_error != 0) return open_error;
    ++opened;
    queued.clear();
    filled.clear();
    return 100 + opened;
  }
  // A mapping keeps the file it is of: the driver hears of a close only when the last of them is gone, and
  // until then the queue is that file's.
  void close(int fd) noexcept override {
    if (fd < 1000) {
      ++closed;
      streaming = false;
      if (fd == owner_) owner_is_closed_ = true;
      free_of_the_closed();
    } else {
      dma_bufs.erase(fd);
    }
  }
  std::int64_t read(int, void*, std::size_t) noexcept override { return -EINVAL; }
  void* map(int, std::size_t size, std::uint64_t offset) noexcept override {
    void* address = buffers[offset]->data();
    mapped[address] = {size, buffers[offset]};
    return address;
  }
  void unmap(void* address, std::size_t) noexcept override {
    mapped.erase(address);
    free_of_the_closed();
  }
  int wait(int, short, Instant deadline) noexcept override {
    int events = poll_error ? POLLERR : 0;
    if (source_change) events |= POLLPRI;
    if (!filled.empty()) events |= POLLIN;
    if (events == 0) clock_.advance_to(deadline);
    return events;
  }
  int control(int fd, unsigned long request, void* argument) noexcept override;

  int opened = 0, closed = 0;
  bool streaming = false;
  std::uint32_t sequence = 0;
  std::deque<std::uint32_t> queued;
  std::map<void*, std::pair<std::size_t, std::shared_ptr<std::vector<std::byte>>>> mapped;
  std::set<int> dma_bufs;
  std::map<std::uint32_t, std::int32_t> controls;  ///< set so far

 private:
  struct Filled {
    std::uint32_t index, sequence, bytes, flags, field;
    Instant at;
  };
  int enumerate(unsigned long request, void* argument) const noexcept;
  int format_or_rate(unsigned long request, void* argument) noexcept;
  int request_buffers(int fd, v4l2_requestbuffers& wanted) noexcept;
  int buffer_call(unsigned long request, void* argument) noexcept;
  void free_of_the_closed() noexcept {
    const bool is_mapped = std::ranges::any_of(
        buffers, [&](const auto& buffer) { return mapped.contains(static_cast<void*>(buffer->data())); });
    if (owner_is_closed_ && !is_mapped) free_buffers();
  }
  void free_buffers() noexcept {
    buffers.clear();
    owner_ = -1;
    owner_is_closed_ = false;
  }
  int dequeue(v4l2_buffer& buffer) noexcept;

  SimulatedClock& clock_;
  std::vector<std::shared_ptr<std::vector<std::byte>>> buffers;
  std::deque<Filled> filled;
  int next_dma_buf_ = 1000;
  int owner_ = -1;  ///< the file whose queue it is
  bool owner_is_closed_ = false;
};

inline int ScriptedCameraDevice::enumerate(unsigned long request, void* argument) const noexcept {
  if (request == VIDIOC_ENUM_FMT) {
    auto& item = *static_cast<v4l2_fmtdesc*>(argument);
    if (item.index > 0) return -EINVAL;
    item.pixelformat = pixel_format;
  } else if (request == VIDIOC_ENUM_FRAMESIZES) {
    auto& item = *static_cast<v4l2_frmsizeenum*>(argument);
    if (item.index > 0) return -EINVAL;
    item.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    item.discrete = {width, height};
  } else if (request == VIDIOC_ENUM_FRAMEINTERVALS) {
    auto& item = *static_cast<v4l2_frmivalenum*>(argument);
    if (item.index > 0) return -EINVAL;
    item.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    item.discrete = {1, rate_hz};
  } else {
    auto& item = *static_cast<v4l2_queryctrl*>(argument);
    if (item.id != V4L2_CTRL_FLAG_NEXT_CTRL) return -EINVAL;
    item = {.id = V4L2_CID_EXPOSURE_ABSOLUTE,
            .type = V4L2_CTRL_TYPE_INTEGER,
            .minimum = 1,
            .maximum = 5000,
            .step = 1,
            .default_value = 157};
    put_name(item.name, "Exposure Time, Absolute");
  }
  return 0;
}

inline int ScriptedCameraDevice::format_or_rate(unsigned long request, void* argument) noexcept {
  if (request == VIDIOC_S_FMT) {
    auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
    pix.pixelformat = pixel_format;
    pix.width = width;
    pix.height = field == V4L2_FIELD_ALTERNATE ? height / 2 : height;
    pix.field = field;
    pix.bytesperline = stride;
    pix.sizeimage = image_bytes;
  } else {
    static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, rate_hz};
  }
  return 0;
}

inline int ScriptedCameraDevice::dequeue(v4l2_buffer& buffer) noexcept {
  if (dequeue_error != 0) return dequeue_error;
  if (!streaming) return -EINVAL;
  if (filled.empty()) return -EAGAIN;
  const Filled& oldest = filled.front();
  const std::int64_t ns = nanos_since_zero(oldest.at);
  buffer.index = oldest.index;
  buffer.sequence = oldest.sequence;
  buffer.bytesused = oldest.bytes;
  buffer.flags = oldest.flags | stamp_flags;
  buffer.field = oldest.field;
  buffer.timestamp = {ns / 1'000'000'000, ns % 1'000'000'000 / 1000};
  filled.pop_front();
  return 0;
}

/// What is mapped outlives its request, as an orphan.
inline int ScriptedCameraDevice::request_buffers(int fd, v4l2_requestbuffers& wanted) noexcept {
  if (owner_ >= 0 && fd != owner_) return -EBUSY;
  free_buffers();
  wanted.count = std::min(wanted.count, buffer_limit);
  for (std::uint32_t i = 0; i < wanted.count; ++i)
    buffers.push_back(std::make_shared<std::vector<std::byte>>(image_bytes));
  if (wanted.count > 0) owner_ = fd;
  return 0;
}

inline int ScriptedCameraDevice::buffer_call(unsigned long request, void* argument) noexcept {
  if (request == VIDIOC_EXPBUF) {
    if (!exports) return -EINVAL;
    static_cast<v4l2_exportbuffer*>(argument)->fd = next_dma_buf_;
    dma_bufs.insert(next_dma_buf_++);
    return 0;
  }
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  if (request == VIDIOC_DQBUF) return dequeue(buffer);
  if (buffer.index >= buffers.size()) return -EINVAL;
  if (request == VIDIOC_QBUF) {
    queued.push_back(buffer.index);
  } else {
    buffer.length = image_bytes;
    buffer.m.offset = buffer.index;
    buffer.flags = stamp_flags;
  }
  return 0;
}

inline int ScriptedCameraDevice::control(int fd, unsigned long request, void* argument) noexcept {
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& capability = *static_cast<v4l2_capability*>(argument);
      put_name(capability.card, "Scripted camera");
      put_name(capability.driver, "scripted");
      capability.capabilities = capabilities;
      return 0;
    }
    case VIDIOC_ENUM_FMT:
    case VIDIOC_ENUM_FRAMESIZES:
    case VIDIOC_ENUM_FRAMEINTERVALS:
    case VIDIOC_QUERYCTRL:
      return enumerate(request, argument);
    case VIDIOC_S_FMT:
      if (owner_ >= 0) return -EBUSY;
      return format_or_rate(request, argument);
    case VIDIOC_S_PARM:
      return format_or_rate(request, argument);
    case VIDIOC_REQBUFS:
      return request_buffers(fd, *static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
    case VIDIOC_QBUF:
    case VIDIOC_DQBUF:
    case VIDIOC_EXPBUF:
      return buffer_call(request, argument);
    case VIDIOC_STREAMON:
      streaming = stream_on_error == 0;
      return stream_on_error;
    case VIDIOC_STREAMOFF:
      streaming = false;
      queued.clear();
      filled.clear();
      return 0;
    case VIDIOC_S_CTRL: {
      const auto& value = *static_cast<v4l2_control*>(argument);
      if (control_error == 0) controls[value.id] = value.value;
      return control_error;
    }
    case VIDIOC_DQEVENT:
      if (!source_change) return -ENOENT;
      source_change = false;
      static_cast<v4l2_event*>(argument)->type = V4L2_EVENT_SOURCE_CHANGE;
      return 0;
    default:
      return -ENOTTY;
  }
}

}  // namespace orcart::testing
