// The driver's buffers as this process sees them: asked for, mapped, exported as dma-bufs where the driver
// can.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "board/ports/port_fault.hpp"
#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// One buffer's memory, unmapped and closed with it. It outlives the device that made it: the kernel keeps
/// the pages while they are mapped.
class BufferMapping {
 public:
  BufferMapping() = default;
  BufferMapping(DeviceCalls& calls, std::byte* data, std::size_t size, int dma_buf_fd) noexcept
      : calls_(&calls), data_(data), size_(size), dma_buf_fd_(dma_buf_fd), dma_buf_id_(new_dma_buf_id()) {}
  BufferMapping(BufferMapping&& other) noexcept { swap(other); }
  BufferMapping& operator=(BufferMapping&& other) noexcept {
    BufferMapping old(static_cast<BufferMapping&&>(*this));
    swap(other);
    return *this;
  }
  ~BufferMapping();

  bool valid() const noexcept { return data_ != nullptr; }
  std::byte* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  int dma_buf_fd() const noexcept { return dma_buf_fd_; }  ///< -1 where the driver exports none
  std::uint64_t dma_buf_id() const noexcept { return dma_buf_id_; }

 private:
  void swap(BufferMapping& other) noexcept;

  DeviceCalls* calls_ = nullptr;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  int dma_buf_fd_ = -1;
  std::uint64_t dma_buf_id_ = 0;
};

struct KernelBuffers {
  std::vector<BufferMapping> mappings;
  bool monotonic_stamps = false;  ///< false: the driver's stamps belong to no clock that is known
};

/// Asks for `count` buffers of at least `bytes`; the driver may give more or fewer, but two at least.
Result<KernelBuffers, PortFault> request_buffers(const OpenDevice& device, std::uint32_t count,
                                                 std::size_t bytes) noexcept;

/// Gives the queue up, so that a device opened anew may have it: whatever of it is mapped stays readable, but
/// is the driver's no longer (Linux 4.20 and later). Closing the device does not do it while one buffer is
/// mapped.
void release_buffers(const OpenDevice& device) noexcept;

/// A buffer that came back filled.
struct FilledBuffer {
  std::uint32_t index = 0, sequence = 0, bytes = 0, field = 0;
  Instant stamp{};
  bool damaged = false;
  bool stamped_at_start = false;  ///< of the exposure; else at the frame's end
};

/// nothing_yet where none is filled; io and disconnected as the driver says.
Result<FilledBuffer, PortFault> dequeue_buffer(const OpenDevice& device) noexcept;
Result<void, PortFault> queue_buffer(const OpenDevice& device, std::uint32_t index) noexcept;

enum class Streaming : std::uint8_t { off, on };
Result<void, PortFault> set_streaming(const OpenDevice& device, Streaming wanted) noexcept;

/// Asks to be told of a change of the signal, where the driver knows such events.
void watch_for_changes(const OpenDevice& device) noexcept;
/// Takes the waiting events; true where one says that the signal changed.
bool signal_changed(const OpenDevice& device) noexcept;

}  // namespace orcart
