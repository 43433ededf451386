// The few calls of libusb that the USB tracker needs, as an interface, so that its link can be tested with a
// scripted device.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "board/linux/usb/ftdi_protocol.hpp"
#include "board/linux/usb/usb_choice.hpp"
#include "board/ports/port_fault.hpp"

namespace orcart {

enum class UsbOutcome : std::uint8_t {
  completed,
  timed_out,
  cancelled,
  gone,    ///< the device was pulled out
  failed,  ///< stall, overflow, or an error on the bus
};

struct UsbTransfer;

class UsbListener {
 public:
  virtual ~UsbListener() = default;
  /// On the thread that calls handle_events(). The transfer may be submitted again at once.
  virtual void on_completed(UsbTransfer& transfer) noexcept = 0;
};

enum class UsbDirection : std::uint8_t { in, out };

/// One bulk transfer with its buffer; it stays where it is from prepare() to the device's end.
struct UsbTransfer {
  static constexpr std::size_t kBytes = 512;
  UsbDirection direction = UsbDirection::in;
  std::array<std::byte, kBytes> bytes{};
  std::size_t size = kBytes;  ///< to send, or room to receive
  std::size_t actual = 0;     ///< sent or received
  UsbOutcome outcome = UsbOutcome::completed;
  UsbListener* listener = nullptr;
  std::atomic<bool> in_flight{false};  ///< set by submit(), cleared before on_completed()
  void* native = nullptr;
};

/// An opened device whose first serial channel is claimed. Its end gives the channel back to the kernel's
/// driver; no transfer may be in flight then.
class UsbDevice {
 public:
  virtual ~UsbDevice() = default;
  /// Takes what the transfer needs, once.
  virtual Result<void, PortFault> prepare(UsbTransfer& transfer) noexcept = 0;
  virtual Result<void, PortFault> submit(UsbTransfer& transfer) noexcept = 0;
  virtual void cancel(UsbTransfer& transfer) noexcept = 0;
  /// Blocks until it was carried out; a millisecond where all is well, 300 at most.
  virtual Result<void, PortFault> control(const ftdi::Request& request) noexcept = 0;
  /// Completes transfers, for at most `most`. One thread.
  virtual void handle_events(Nanos most) noexcept = 0;
  /// Lets handle_events() return at once. Any thread.
  virtual void interrupt_events() noexcept = 0;
  virtual std::size_t packet_bytes() const noexcept = 0;
  /// More than one serial channel on the chip.
  virtual bool has_channels() const noexcept = 0;
};

class UsbBus {
 public:
  virtual ~UsbBus() = default;
  /// NDI's and plain FTDI devices, looked for afresh at each call. Allocates.
  virtual Result<std::vector<UsbDeviceId>, PortFault> list() noexcept = 0;
  /// Takes the device from the kernel's driver.
  virtual Result<std::unique_ptr<UsbDevice>, PortFault> open(const UsbDeviceId& device) noexcept = 0;
};

}  // namespace orcart
