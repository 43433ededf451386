// Nothing but libusb's calls, and their errors in our words.
#include "board/linux/usb/libusb_bus.hpp"

#include <libusb.h>

#include <algorithm>

namespace orcart {
namespace {

constexpr int kInterface = 0;
constexpr std::uint8_t kVendorOut = 0x40;
constexpr unsigned kControlPatienceMs = 300;
constexpr unsigned kSendPatienceMs = 100;

struct ContextEnd {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};
struct HandleEnd {
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
};
using Context = std::unique_ptr<libusb_context, ContextEnd>;
using Handle = std::unique_ptr<libusb_device_handle, HandleEnd>;

PortFault fault_of(int error) noexcept {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return PortFault::no_permission;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return PortFault::disconnected;
    case LIBUSB_ERROR_BUSY:
      return PortFault::busy;
    case LIBUSB_ERROR_TIMEOUT:
      return PortFault::timed_out;
    case LIBUSB_ERROR_NOT_SUPPORTED:
      return PortFault::unsupported;
    default:
      return PortFault::io;
  }
}

UsbOutcome outcome_of(libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return UsbOutcome::completed;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return UsbOutcome::timed_out;
    case LIBUSB_TRANSFER_CANCELLED:
      return UsbOutcome::cancelled;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return UsbOutcome::gone;
    default:
      return UsbOutcome::failed;
  }
}

Result<Context, PortFault> new_context() noexcept {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != 0) return tl::unexpected(fault_of(error));
  return Context(context);
}

/// As the kernel names a port: bus, then the way through the hubs.
std::string port_path_of(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = std::to_string(libusb_get_bus_number(device)) + "-";
  for (int i = 0; i < count; ++i) {
    if (i > 0) path += '.';
    path += std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return path;
}

/// Empty where there is none, or this user may not ask.
std::string serial_of(libusb_device* device, std::uint8_t index) {
  libusb_device_handle* opened = nullptr;
  if (index == 0 || libusb_open(device, &opened) != 0) return {};
  const Handle handle(opened);
  std::array<unsigned char, 128> text{};
  const int size =
      libusb_get_string_descriptor_ascii(handle.get(), index, text.data(), static_cast<int>(text.size()));
  return size > 0 ? std::string(reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(size))
                  : "";
}

/// Calls `see` for each NDI or FTDI device until it returns true.
template <class See>
void look_at_devices(libusb_context* context, See see) {
  libusb_device** devices = nullptr;
  const ssize_t count = libusb_get_device_list(context, &devices);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(devices[i], &descriptor) != 0) continue;
    if (usb_name_of(descriptor.idVendor, descriptor.idProduct).empty()) continue;
    if (see(devices[i], descriptor)) break;
  }
  if (count >= 0) libusb_free_device_list(devices, 1);
}

/// The bulk endpoints of the first channel.
struct Endpoints {
  std::uint8_t in = 0;
  std::uint8_t out = 0;
  std::size_t packet_bytes = 64;
  bool more_channels = false;
};

Result<Endpoints, PortFault> endpoints_of(libusb_device_handle* handle) noexcept {
  libusb_config_descriptor* config = nullptr;
  const int error = libusb_get_active_config_descriptor(libusb_get_device(handle), &config);
  if (error != 0) return tl::unexpected(fault_of(error));
  Endpoints found{.more_channels = config->bNumInterfaces > 1};
  if (config->bNumInterfaces > 0 && config->interface[kInterface].num_altsetting > 0) {
    const libusb_interface_descriptor& channel = config->interface[kInterface].altsetting[0];
    for (std::uint8_t i = 0; i < channel.bNumEndpoints; ++i) {
      const libusb_endpoint_descriptor& end = channel.endpoint[i];
      if ((end.bmAttributes & 0x03) != LIBUSB_TRANSFER_TYPE_BULK) continue;
      if ((end.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0) {
        found.in = end.bEndpointAddress;
        found.packet_bytes = end.wMaxPacketSize;
      } else {
        found.out = end.bEndpointAddress;
      }
    }
  }
  libusb_free_config_descriptor(config);
  if (found.in == 0 || found.out == 0) return tl::unexpected(PortFault::unsupported);
  return found;
}

void LIBUSB_CALL completed(libusb_transfer* native) {
  auto& transfer = *static_cast<UsbTransfer*>(native->user_data);
  transfer.actual = static_cast<std::size_t>(std::max(0, native->actual_length));
  transfer.outcome = outcome_of(native->status);
  transfer.in_flight.store(false, std::memory_order_release);  // partner: the acquires in UsbLink
  transfer.listener->on_completed(transfer);
}

class LibusbDevice final : public UsbDevice {
 public:
  LibusbDevice(Context context, Handle handle, const Endpoints& ends) noexcept
      : context_(std::move(context)), handle_(std::move(handle)), ends_(ends) {}
  ~LibusbDevice() override {
    for (libusb_transfer* native : natives_) libusb_free_transfer(native);
    // With the automatic detaching asked for, this hands the channel back to the kernel's driver.
    libusb_release_interface(handle_.get(), kInterface);
  }

  Result<void, PortFault> prepare(UsbTransfer& transfer) noexcept override {
    if (native_count_ == natives_.size()) return tl::unexpected(PortFault::unsupported);
    libusb_transfer* native = libusb_alloc_transfer(0);
    if (native == nullptr) return tl::unexpected(PortFault::io);
    natives_[native_count_++] = native;
    transfer.native = native;
    transfer.in_flight.store(false, std::memory_order_relaxed);  // nobody else knows it yet
    return {};
  }
  Result<void, PortFault> submit(UsbTransfer& transfer) noexcept override {
    auto* native = static_cast<libusb_transfer*>(transfer.native);
    const bool in = transfer.direction == UsbDirection::in;
    libusb_fill_bulk_transfer(native, handle_.get(), in ? ends_.in : ends_.out,
                              reinterpret_cast<unsigned char*>(transfer.bytes.data()),
                              static_cast<int>(in ? transfer.bytes.size() : transfer.size), &completed,
                              &transfer, in ? 0 : kSendPatienceMs);
    transfer.in_flight.store(true, std::memory_order_release);
    const int error = libusb_submit_transfer(native);
    if (error == 0) return {};
    transfer.in_flight.store(false, std::memory_order_release);
    return tl::unexpected(fault_of(error));
  }
  void cancel(UsbTransfer& transfer) noexcept override {
    libusb_cancel_transfer(static_cast<libusb_transfer*>(transfer.native));
  }
  Result<void, PortFault> control(const ftdi::Request& request) noexcept override {
    const int count = libusb_control_transfer(handle_.get(), kVendorOut, request.request, request.value,
                                              request.index, nullptr, 0, kControlPatienceMs);
    if (count < 0) return tl::unexpected(fault_of(count));
    return {};
  }
  void handle_events(Nanos most) noexcept override {
    timeval time{.tv_sec = most / 1s, .tv_usec = (most % 1s) / 1us};
    libusb_handle_events_timeout_completed(context_.get(), &time, nullptr);
  }
  void interrupt_events() noexcept override { libusb_interrupt_event_handler(context_.get()); }
  std::size_t packet_bytes() const noexcept override { return ends_.packet_bytes; }
  bool has_channels() const noexcept override { return ends_.more_channels; }

 private:
  Context context_;
  Handle handle_;
  Endpoints ends_;
  std::array<libusb_transfer*, 16> natives_{};
  std::size_t native_count_ = 0;
};

}  // namespace

Result<std::vector<UsbDeviceId>, PortFault> LibusbBus::list() noexcept {
  const auto context = new_context();
  if (!context) return tl::unexpected(context.error());
  std::vector<UsbDeviceId> found;
  look_at_devices(context->get(), [&](libusb_device* device, const libusb_device_descriptor& descriptor) {
    found.push_back({.vendor = descriptor.idVendor,
                     .product = descriptor.idProduct,
                     .bcd_device = descriptor.bcdDevice,
                     .port_path = port_path_of(device),
                     .serial = serial_of(device, descriptor.iSerialNumber)});
    return false;
  });
  return found;
}

Result<std::unique_ptr<UsbDevice>, PortFault> LibusbBus::open(const UsbDeviceId& wanted) noexcept {
  auto context = new_context();
  if (!context) return tl::unexpected(context.error());
  libusb_device_handle* opened = nullptr;
  int error = LIBUSB_ERROR_NO_DEVICE;
  look_at_devices(context->get(), [&](libusb_device* device, const libusb_device_descriptor& descriptor) {
    const bool found = descriptor.idVendor == wanted.vendor && descriptor.idProduct == wanted.product &&
                       port_path_of(device) == wanted.port_path;
    if (found) error = libusb_open(device, &opened);
    return found;
  });
  if (error != 0) return tl::unexpected(fault_of(error));
  Handle handle(opened);
  libusb_set_auto_detach_kernel_driver(handle.get(), 1);
  const auto ends = endpoints_of(handle.get());
  if (!ends) return tl::unexpected(ends.error());
  if (error = libusb_claim_interface(handle.get(), kInterface); error != 0)
    return tl::unexpected(fault_of(error));
  return std::make_unique<LibusbDevice>(std::move(*context), std::move(handle), *ends);
}

}  // namespace orcart
