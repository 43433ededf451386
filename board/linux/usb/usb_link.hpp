// The tracker over USB: an FTDI bridge spoken to directly, without the kernel's serial driver.
#pragma once

#include <pthread.h>

#include <array>
#include <memory>
#include <string>

#include "board/linux/file_descriptor.hpp"
#include "board/linux/usb/usb_bus.hpp"
#include "board/ports/byte_link.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/spsc_queue.hpp"
#include "realtime/kernel/thread_spec.hpp"

namespace orcart {

/// What the link has seen; any thread.
struct UsbLinkFigures {
  std::uint64_t packets_lost = 0;      ///< the reader was too slow
  std::uint64_t failed_transfers = 0;  ///< errors on the bus that were survived
  ftdi::LineErrors line;
};

/// Transfers are taken once at opening and go round; an event thread of its own completes them, strips the
/// status bytes and stamps what came. One thread calls the ByteLink. write(), read() and wait() allocate
/// nothing; set_line() and reopen() block for milliseconds, send_break() for a quarter of a second.
class UsbLink final : public ByteLink, private UsbListener {
 public:
  /// Refused in a sentence: not there, several there, busy, no permission.
  static Result<std::unique_ptr<UsbLink>> open(std::unique_ptr<UsbBus> bus, const UsbChoice& choice);
  ~UsbLink() override { close(); }
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override;
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override;
  Instant last_arrival() const noexcept override { return last_arrival_; }
  void discard_input() noexcept override;
  Result<void, PortFault> set_line(const LineSettings& line) noexcept override;
  Result<void, PortFault> send_break() noexcept override;
  /// Looks for the same device again: by serial number or port where it was chosen so, else at any port.
  Result<void, PortFault> reopen() noexcept override;
  void wait(Instant deadline) noexcept override;

  const UsbDeviceId& device() const noexcept { return id_; }
  UsbLinkFigures figures() const noexcept;

 private:
  static constexpr std::size_t kTransfers = 4;
  static constexpr std::size_t kChunks = 64;
  /// What one transfer brought.
  struct Chunk {
    Instant at{};
    std::size_t size = 0;
    std::array<std::byte, UsbTransfer::kBytes> bytes;
  };

  UsbLink(std::unique_ptr<UsbBus> bus, const UsbChoice& choice) noexcept;
  Result<void, PortFault> set_up(const UsbDeviceId& id) noexcept;
  Result<void, PortFault> tell_chip() noexcept;
  Result<void, PortFault> begin() noexcept;
  void close() noexcept;
  bool any_in_flight() const noexcept;
  void on_completed(UsbTransfer& transfer) noexcept override;
  void take(UsbTransfer& transfer) noexcept;
  void raise(PortFault fault) noexcept;
  bool next_chunk() noexcept;
  static void* event_thread(void* self);

  const std::unique_ptr<UsbBus> bus_;
  const UsbChoice choice_;
  UsbDeviceId id_;
  ftdi::Chip chip_;
  FileDescriptor awake_;  ///< an eventfd: written by the event thread, slept on by wait()

  std::array<UsbTransfer, kTransfers> in_;
  std::array<UsbTransfer, kTransfers> out_;
  SpscQueue<Chunk> arrived_{kChunks};
  Chunk current_;
  std::size_t taken_ = 0;
  Instant last_arrival_{};

  std::unique_ptr<UsbDevice> device_;
  pthread_t thread_{};
  bool thread_runs_ = false;
  std::atomic<bool> closing_{false};
  std::atomic<int> fault_{-1};  ///< a PortFault once the device has failed
  std::atomic<std::uint32_t> failed_in_a_row_{0};
  std::atomic<std::uint64_t> failed_transfers_{0};
  std::atomic<std::uint32_t> overruns_{0}, parity_{0}, framing_{0}, breaks_{0};
};

}  // namespace orcart
