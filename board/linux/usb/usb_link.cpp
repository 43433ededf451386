// Opens the bridge, keeps its transfers going round, and closes it so that nothing leaks.
#include "board/linux/usb/usb_link.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cstring>

#include "realtime/kernel/realtime_rights.hpp"

namespace orcart {
namespace {

constexpr std::uint8_t kLatencyTimerMs = 1;
constexpr Nanos kBreak = 250ms;
constexpr Nanos kEventPatience = 50ms;
constexpr Nanos kClosePatience = 2s;
constexpr std::uint32_t kTolerated = 3;
constexpr ThreadSpec kEventThread{.name = "usb events", .fifo_priority = 81, .stack_bytes = 256 * 1024};

std::string remedy(PortFault fault) {
  switch (fault) {
    case PortFault::no_permission:
      return "; a udev rule that lets this user in is wanted (board/cart has one)";
    case PortFault::busy:
      return "; end the program that holds it";
    default:
      return "; unplug it and plug it in again";
  }
}

}  // namespace

UsbLink::UsbLink(std::unique_ptr<UsbBus> bus, const UsbChoice& choice) noexcept
    : bus_(std::move(bus)), choice_(choice), awake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  for (UsbTransfer& transfer : out_) transfer.direction = UsbDirection::out;
}

Result<std::unique_ptr<UsbLink>> UsbLink::open(std::unique_ptr<UsbBus> bus, const UsbChoice& choice) {
  std::unique_ptr<UsbLink> link(new UsbLink(std::move(bus), choice));
  if (!link->awake_.valid())
    return fail("the USB tracker needs one more file descriptor than this program may have");
  const auto devices = link->bus_->list();
  if (!devices)
    return fail("the USB bus cannot be looked at: " + std::string(word_for(devices.error())) +
                "; a mounted /dev/bus/usb or /sys is wanted");
  const auto id = choose_tracker(*devices, choice);
  if (!id) return tl::unexpected(id.error());
  if (const auto opened = link->set_up(*id); !opened)
    return fail("USB tracker " + description_of(*id) +
                " cannot be opened: " + std::string(word_for(opened.error())) + remedy(opened.error()));
  return link;
}

Result<void, PortFault> UsbLink::reopen() noexcept {
  close();
  const auto devices = bus_->list();
  if (!devices) return tl::unexpected(devices.error());
  const auto id = choose_tracker(*devices, choice_);
  if (!id) return tl::unexpected(PortFault::disconnected);
  return set_up(*id);
}

Result<void, PortFault> UsbLink::set_up(const UsbDeviceId& id) noexcept {
  auto device = bus_->open(id);
  if (!device) return tl::unexpected(device.error());
  device_ = std::move(*device);
  id_ = id;
  chip_ = {.base = ftdi::clock_base_of(id.bcd_device),
           .channel = static_cast<std::uint8_t>(device_->has_channels() ? 1 : 0)};
  fault_.store(-1, std::memory_order_relaxed);  // no thread yet
  failed_in_a_row_.store(0, std::memory_order_relaxed);
  auto done = tell_chip();
  if (done) done = begin();
  if (!done) close();
  return done;
}

Result<void, PortFault> UsbLink::tell_chip() noexcept {
  const auto baud = ftdi::set_baud(chip_, LineSettings{}.baud);
  const std::array<ftdi::Request, 8> requests{ftdi::reset(chip_),
                                              ftdi::purge_receive(chip_),
                                              ftdi::purge_transmit(chip_),
                                              ftdi::set_latency_timer(chip_, kLatencyTimerMs),
                                              ftdi::set_data(chip_, ftdi::Break::off),
                                              ftdi::set_flow(chip_, FlowControl::none),
                                              ftdi::raise_modem_lines(chip_),
                                              baud.value_or(ftdi::Request{})};
  for (const ftdi::Request& request : requests) {
    if (const auto told = device_->control(request); !told) return told;
  }
  return {};
}

Result<void, PortFault> UsbLink::begin() noexcept {
  for (auto* transfers : {&in_, &out_}) {
    for (UsbTransfer& transfer : *transfers) {
      transfer.listener = this;
      transfer.native = nullptr;
      if (const auto prepared = device_->prepare(transfer); !prepared) return prepared;
    }
  }
  closing_.store(false, std::memory_order_relaxed);  // partner: pthread_create
  for (UsbTransfer& transfer : in_) {
    if (const auto submitted = device_->submit(transfer); !submitted) return submitted;
  }
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kEventThread.stack_bytes);
  thread_runs_ = pthread_create(&thread_, &attributes, &UsbLink::event_thread, this) == 0;
  pthread_attr_destroy(&attributes);
  if (!thread_runs_) return tl::unexpected(PortFault::io);
  return {};
}

void* UsbLink::event_thread(void* self) {
  auto& link = *static_cast<UsbLink*>(self);
  (void)acquire_thread_rights(kEventThread);
  // Bound: one turn a wake-up, until close(). Partner of the acquire: the release there.
  while (!link.closing_.load(std::memory_order_acquire)) link.device_->handle_events(kEventPatience);
  return nullptr;
}

bool UsbLink::any_in_flight() const noexcept {
  const auto flies = [](const UsbTransfer& transfer) {
    return transfer.in_flight.load(std::memory_order_acquire);  // partner: the device's release
  };
  return std::any_of(in_.begin(), in_.end(), flies) || std::any_of(out_.begin(), out_.end(), flies);
}

void UsbLink::close() noexcept {
  if (device_ == nullptr) return;
  closing_.store(true,
                 std::memory_order_release);  // partner: the acquire in event_thread() and on_completed()
  for (auto* transfers : {&in_, &out_}) {
    for (UsbTransfer& transfer : *transfers) {
      if (transfer.in_flight.load(std::memory_order_acquire)) device_->cancel(transfer);
    }
  }
  if (thread_runs_) {
    device_->interrupt_events();
    pthread_join(thread_, nullptr);
  }
  thread_runs_ = false;
  RealClock clock;
  const Instant end = clock.now() + kClosePatience;
  while (any_in_flight() && clock.now() < end) device_->handle_events(kEventPatience);
  // A transfer that never comes home may still write into its buffer: then the device is left open for good.
  if (any_in_flight()) (void)device_.release();
  device_.reset();
  discard_input();
}

void UsbLink::raise(PortFault fault) noexcept {
  fault_.store(static_cast<int>(fault),
               std::memory_order_release);  // partner: the acquire in read() and wait()
  (void)::eventfd_write(awake_.get(), 1);
}

void UsbLink::on_completed(UsbTransfer& transfer) noexcept {
  if (transfer.outcome == UsbOutcome::gone) return raise(PortFault::disconnected);
  if (closing_.load(std::memory_order_acquire)) return;  // partner: the release in close()
  if (transfer.outcome == UsbOutcome::failed) {
    failed_transfers_.fetch_add(1, std::memory_order_relaxed);  // a count alone
    if (failed_in_a_row_.fetch_add(1, std::memory_order_relaxed) + 1 > kTolerated)
      return raise(PortFault::disconnected);
  } else {
    failed_in_a_row_.store(0, std::memory_order_relaxed);
  }
  if (transfer.direction == UsbDirection::out) return;
  if (transfer.outcome == UsbOutcome::completed) take(transfer);
  if (!device_->submit(transfer)) raise(PortFault::disconnected);
}

void UsbLink::take(UsbTransfer& transfer) noexcept {
  Chunk chunk{.at = RealClock{}.now()};
  ftdi::LineErrors seen;
  chunk.size = ftdi::strip_status(std::span{transfer.bytes}.first(transfer.actual), device_->packet_bytes(),
                                  chunk.bytes, seen);
  // Counts alone, no partner.
  if (seen.overruns > 0) overruns_.fetch_add(seen.overruns, std::memory_order_relaxed);
  if (seen.parity > 0) parity_.fetch_add(seen.parity, std::memory_order_relaxed);
  if (seen.framing > 0) framing_.fetch_add(seen.framing, std::memory_order_relaxed);
  if (seen.breaks > 0) breaks_.fetch_add(seen.breaks, std::memory_order_relaxed);
  if (chunk.size == 0) return;
  (void)arrived_.try_push(chunk);
  (void)::eventfd_write(awake_.get(), 1);
}

Result<void, PortFault> UsbLink::write(std::span<const std::byte> bytes) noexcept {
  if (device_ == nullptr) return tl::unexpected(PortFault::disconnected);
  if (bytes.size() > UsbTransfer::kBytes) return tl::unexpected(PortFault::unsupported);
  for (UsbTransfer& transfer : out_) {
    if (transfer.in_flight.load(std::memory_order_acquire)) continue;  // partner: the device's release
    std::copy(bytes.begin(), bytes.end(), transfer.bytes.begin());
    transfer.size = bytes.size();
    return device_->submit(transfer);
  }
  return tl::unexpected(PortFault::timed_out);
}

bool UsbLink::next_chunk() noexcept {
  taken_ = 0;
  if (arrived_.try_pop(current_)) return true;
  current_.size = 0;
  return false;
}

Result<std::size_t, PortFault> UsbLink::read(std::span<std::byte> into) noexcept {
  if (device_ == nullptr) return tl::unexpected(PortFault::disconnected);
  eventfd_t events = 0;
  (void)::eventfd_read(awake_.get(), &events);
  // Before the queue: what arrived ahead of the fault is still handed out. Partner: the release in raise().
  const int fault = fault_.load(std::memory_order_acquire);
  std::size_t count = 0;
  while (count < into.size() && (taken_ < current_.size || next_chunk())) {
    const std::size_t some = std::min(into.size() - count, current_.size - taken_);
    std::memcpy(into.data() + count, current_.bytes.data() + taken_, some);
    taken_ += some;
    count += some;
    last_arrival_ = current_.at;
  }
  if (count > 0 || fault < 0) return count;
  close();
  return tl::unexpected(static_cast<PortFault>(fault));
}

void UsbLink::discard_input() noexcept {
  while (next_chunk()) {  // bound: the queue's depth and what comes meanwhile, one packet a millisecond
  }
}

Result<void, PortFault> UsbLink::set_line(const LineSettings& line) noexcept {
  if (device_ == nullptr) return tl::unexpected(PortFault::disconnected);
  const auto baud = ftdi::set_baud(chip_, line_rate_for(id_.vendor, id_.product, line.baud));
  if (!baud) return tl::unexpected(PortFault::unsupported);
  for (const ftdi::Request& request : {*baud, ftdi::set_flow(chip_, line.flow)}) {
    if (const auto told = device_->control(request); !told) return told;
  }
  return {};
}

Result<void, PortFault> UsbLink::send_break() noexcept {
  if (device_ == nullptr) return tl::unexpected(PortFault::disconnected);
  if (const auto on = device_->control(ftdi::set_data(chip_, ftdi::Break::on)); !on) return on;
  RealClock clock;
  clock.sleep_until(clock.now() + kBreak);
  return device_->control(ftdi::set_data(chip_, ftdi::Break::off));
}

void UsbLink::wait(Instant deadline) noexcept {
  RealClock clock;
  if (device_ == nullptr) return clock.sleep_until(deadline);
  const bool ready = taken_ < current_.size || arrived_.size() > 0 ||
                     fault_.load(std::memory_order_acquire) >= 0;  // partner: the release in raise()
  if (ready) return;
  const std::int64_t left = std::max<std::int64_t>(0, (deadline - clock.now()).count());
  const timespec timeout{.tv_sec = left / 1'000'000'000, .tv_nsec = left % 1'000'000'000};
  pollfd watched{.fd = awake_.get(), .events = POLLIN, .revents = 0};
  ::ppoll(&watched, 1, &timeout, nullptr);
}

UsbLinkFigures UsbLink::figures() const noexcept {
  // Counts alone, no partner.
  return {.packets_lost = arrived_.dropped(),
          .failed_transfers = failed_transfers_.load(std::memory_order_relaxed),
          .line = {.overruns = overruns_.load(std::memory_order_relaxed),
                   .parity = parity_.load(std::memory_order_relaxed),
                   .framing = framing_.load(std::memory_order_relaxed),
                   .breaks = breaks_.load(std::memory_order_relaxed)}};
}

}  // namespace orcart
