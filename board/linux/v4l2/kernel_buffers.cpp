// VIDIOC_REQBUFS and what follows; every driver's error becomes a port's fault.
#include "board/linux/v4l2/kernel_buffers.hpp"

#include <fcntl.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <utility>

namespace orcart {
namespace {

// EIO is a failed transfer here: the stream can be started again. EPIPE is a stream that ended.
PortFault stream_fault_of(int error_number) noexcept {
  switch (error_number) {
    case EAGAIN:
      return PortFault::nothing_yet;
    case ENODEV:
    case ENXIO:
    case EBADF:
      return PortFault::disconnected;
    case EBUSY:
      return PortFault::busy;
    default:
      return PortFault::io;
  }
}

Result<void, PortFault> done(int answer) noexcept {
  if (answer < 0) return tl::unexpected(stream_fault_of(-answer));
  return {};
}

v4l2_buffer buffer_named(std::uint32_t index) noexcept {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

int export_buffer(const OpenDevice& device, std::uint32_t index) noexcept {
  v4l2_exportbuffer wanted{};
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  wanted.index = index;
  wanted.flags = O_RDONLY | O_CLOEXEC;
  return device.control(VIDIOC_EXPBUF, &wanted) < 0 ? -1 : wanted.fd;
}

}  // namespace

BufferMapping::~BufferMapping() {
  if (data_ != nullptr) calls_->unmap(data_, size_);
  if (dma_buf_fd_ >= 0) calls_->close(dma_buf_fd_);
}

void BufferMapping::swap(BufferMapping& other) noexcept {
  std::swap(calls_, other.calls_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(dma_buf_fd_, other.dma_buf_fd_);
  std::swap(dma_buf_id_, other.dma_buf_id_);
}

Result<KernelBuffers, PortFault> request_buffers(const OpenDevice& device, std::uint32_t count,
                                                 std::size_t bytes) noexcept {
  v4l2_requestbuffers request{};
  request.count = count;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (auto granted = done(device.control(VIDIOC_REQBUFS, &request)); !granted)
    return tl::unexpected(granted.error());
  if (request.count < 2) return tl::unexpected(PortFault::unsupported);
  KernelBuffers buffers;
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = buffer_named(i);
    if (auto told = done(device.control(VIDIOC_QUERYBUF, &buffer)); !told)
      return tl::unexpected(told.error());
    if (buffer.length < bytes) return tl::unexpected(PortFault::unsupported);
    void* data = device.calls().map(device.fd(), buffer.length, buffer.m.offset);
    if (data == nullptr) return tl::unexpected(PortFault::io);
    buffers.mappings.emplace_back(device.calls(), static_cast<std::byte*>(data), buffer.length,
                                  export_buffer(device, i));
    buffers.monotonic_stamps =
        (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  }
  return buffers;
}

// A mapping keeps its file alive: close() alone would leave the queue with its owner until the last one is
// gone.
void release_buffers(const OpenDevice& device) noexcept {
  v4l2_requestbuffers none{};
  none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  none.memory = V4L2_MEMORY_MMAP;
  (void)device.control(VIDIOC_REQBUFS, &none);
}

Result<FilledBuffer, PortFault> dequeue_buffer(const OpenDevice& device) noexcept {
  v4l2_buffer buffer = buffer_named(0);
  if (auto taken = done(device.control(VIDIOC_DQBUF, &buffer)); !taken) return tl::unexpected(taken.error());
  return FilledBuffer{
      .index = buffer.index,
      .sequence = buffer.sequence,
      .bytes = buffer.bytesused,
      .field = buffer.field,
      .stamp = instant_from_nanos(std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 +
                                  std::int64_t{buffer.timestamp.tv_usec} * 1000),
      .damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0,
      .stamped_at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE};
}

Result<void, PortFault> queue_buffer(const OpenDevice& device, std::uint32_t index) noexcept {
  v4l2_buffer buffer = buffer_named(index);
  return done(device.control(VIDIOC_QBUF, &buffer));
}

Result<void, PortFault> set_streaming(const OpenDevice& device, Streaming wanted) noexcept {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return done(device.control(wanted == Streaming::on ? VIDIOC_STREAMON : VIDIOC_STREAMOFF, &type));
}

void watch_for_changes(const OpenDevice& device) noexcept {
  v4l2_event_subscription wanted{};
  wanted.type = V4L2_EVENT_SOURCE_CHANGE;
  (void)device.control(VIDIOC_SUBSCRIBE_EVENT, &wanted);
}

bool signal_changed(const OpenDevice& device) noexcept {
  bool changed = false;
  for (int i = 0; i < 16; ++i) {
    v4l2_event event{};
    if (device.control(VIDIOC_DQEVENT, &event) < 0) break;
    changed = changed || event.type == V4L2_EVENT_SOURCE_CHANGE;
  }
  return changed;
}

}  // namespace orcart
