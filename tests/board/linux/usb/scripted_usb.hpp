// A scripted FTDI bridge behind the calls of libusb, with a tracker behind it that answers INIT.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>

#include "board/linux/usb/usb_bus.hpp"

namespace orcart::testing {

/// What the device does and what happened to it; outlives the devices that were opened on it.
struct ScriptedUsb {
  std::mutex mutex;
  std::condition_variable changed;
  bool plugged = true;
  PortFault open_fault = PortFault::nothing_yet;  ///< other than that: open() fails so
  int fail_control_at = -1;                       ///< the n-th control request of a device fails
  int fail_prepare_at = -1;
  bool swallow_out = false;  ///< transfers to the device stay in flight
  UsbDeviceId id{
      .vendor = 0x0403, .product = 0xDA70, .bcd_device = 0x0400, .port_path = "1-1", .serial = "P6-1"};

  int opened = 0, closed = 0;
  std::vector<ftdi::Request> requests;
  std::string received;
  int still_in_flight_at_close = 0;

  void unplug() {
    const std::lock_guard lock(mutex);
    plugged = false;
    changed.notify_all();
  }
  void plug_in() {
    const std::lock_guard lock(mutex);
    plugged = true;
  }
  /// Bytes for the host, as one transfer's worth of packets with their status bytes.
  void send(std::string_view text, int status = 0x60, std::size_t packet_bytes = 64) {
    std::vector<std::byte> bytes;
    do {
      const auto part = text.substr(0, packet_bytes - 2);
      bytes.push_back(std::byte{0x01});
      bytes.push_back(static_cast<std::byte>(status));
      for (const char letter : part) bytes.push_back(static_cast<std::byte>(letter));
      text.remove_prefix(part.size());
    } while (!text.empty());
    complete_in({.bytes = std::move(bytes), .outcome = UsbOutcome::completed});
  }
  void fail_in() { complete_in({.bytes = {}, .outcome = UsbOutcome::failed}); }

  struct Arrival {
    std::vector<std::byte> bytes;
    UsbOutcome outcome;
  };
  std::deque<Arrival> arrivals;

 private:
  void complete_in(Arrival arrival) {
    const std::lock_guard lock(mutex);
    arrivals.push_back(std::move(arrival));
    changed.notify_all();
  }
};

class ScriptedDevice final : public UsbDevice {
 public:
  explicit ScriptedDevice(ScriptedUsb& script) : script_(script) {}
  ~ScriptedDevice() override {
    const std::lock_guard lock(script_.mutex);
    ++script_.closed;
    for (const UsbTransfer* transfer : prepared_)
      script_.still_in_flight_at_close += transfer->in_flight ? 1 : 0;
  }
  Result<void, PortFault> prepare(UsbTransfer& transfer) noexcept override {
    if (static_cast<int>(prepared_.size()) == script_.fail_prepare_at) return tl::unexpected(PortFault::io);
    prepared_.push_back(&transfer);
    return {};
  }
  Result<void, PortFault> submit(UsbTransfer& transfer) noexcept override {
    const std::lock_guard lock(script_.mutex);
    if (!script_.plugged) return tl::unexpected(PortFault::disconnected);
    transfer.in_flight = true;
    if (transfer.direction == UsbDirection::in) {
      waiting_.push_back(&transfer);
    } else if (script_.swallow_out) {
      stuck_.push_back(&transfer);
    } else {
      done_.push_back({&transfer, UsbOutcome::completed});
      for (std::size_t i = 0; i < transfer.size; ++i)
        script_.received += static_cast<char>(transfer.bytes[i]);
      if (script_.received.ends_with("INIT:E3A5\r")) {
        script_.arrivals.push_back({status_and("OKAYA896\r"), UsbOutcome::completed});
      }
    }
    script_.changed.notify_all();
    return {};
  }
  void cancel(UsbTransfer& transfer) noexcept override {
    const std::lock_guard lock(script_.mutex);
    for (auto* list : {&waiting_, &stuck_}) {
      if (std::erase(*list, &transfer) > 0) done_.push_back({&transfer, UsbOutcome::cancelled});
    }
    script_.changed.notify_all();
  }
  Result<void, PortFault> control(const ftdi::Request& request) noexcept override {
    const std::lock_guard lock(script_.mutex);
    if (!script_.plugged) return tl::unexpected(PortFault::disconnected);
    if (controls_++ == script_.fail_control_at) return tl::unexpected(PortFault::io);
    script_.requests.push_back(request);
    return {};
  }
  void handle_events(Nanos most) noexcept override {
    std::unique_lock lock(script_.mutex);
    script_.changed.wait_for(lock, most, [&] { return interrupted_ || ready(); });
    interrupted_ = false;
    gather();
    while (!done_.empty()) {
      const auto [transfer, outcome] = done_.front();
      done_.pop_front();
      transfer->outcome = outcome;
      transfer->in_flight = false;
      lock.unlock();
      transfer->listener->on_completed(*transfer);
      lock.lock();
    }
  }
  void interrupt_events() noexcept override {
    const std::lock_guard lock(script_.mutex);
    interrupted_ = true;
    script_.changed.notify_all();
  }
  std::size_t packet_bytes() const noexcept override { return 64; }
  bool has_channels() const noexcept override { return false; }

 private:
  static std::vector<std::byte> status_and(std::string_view text) {
    std::vector<std::byte> bytes{std::byte{1}, std::byte{0x60}};
    for (const char letter : text) bytes.push_back(static_cast<std::byte>(letter));
    return bytes;
  }
  bool ready() const {
    return !done_.empty() || (!script_.plugged && !waiting_.empty()) ||
           (!script_.arrivals.empty() && !waiting_.empty());
  }
  void gather() {
    if (!script_.plugged) {
      for (auto* list : {&waiting_, &stuck_}) {
        for (UsbTransfer* transfer : *list) done_.push_back({transfer, UsbOutcome::gone});
        list->clear();
      }
      return;
    }
    while (!script_.arrivals.empty() && !waiting_.empty()) {
      const ScriptedUsb::Arrival arrival = script_.arrivals.front();
      script_.arrivals.pop_front();
      UsbTransfer* transfer = waiting_.front();
      waiting_.erase(waiting_.begin());
      std::copy(arrival.bytes.begin(), arrival.bytes.end(), transfer->bytes.begin());
      transfer->actual = arrival.bytes.size();
      done_.push_back({transfer, arrival.outcome});
    }
  }

  ScriptedUsb& script_;
  std::vector<UsbTransfer*> prepared_, waiting_, stuck_;
  std::deque<std::pair<UsbTransfer*, UsbOutcome>> done_;
  bool interrupted_ = false;
  int controls_ = 0;
};

class ScriptedBus final : public UsbBus {
 public:
  explicit ScriptedBus(ScriptedUsb& script) : script_(script) {}
  Result<std::vector<UsbDeviceId>, PortFault> list() noexcept override {
    const std::lock_guard lock(script_.mutex);
    return script_.plugged ? std::vector{script_.id} : std::vector<UsbDeviceId>{};
  }
  Result<std::unique_ptr<UsbDevice>, PortFault> open(const UsbDeviceId&) noexcept override {
    const std::lock_guard lock(script_.mutex);
    if (script_.open_fault != PortFault::nothing_yet) return tl::unexpected(script_.open_fault);
    ++script_.opened;
    return std::make_unique<ScriptedDevice>(script_);
  }

 private:
  ScriptedUsb& script_;
};

}  // namespace orcart::testing
