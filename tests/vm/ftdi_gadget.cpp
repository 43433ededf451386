// Numbers as in the Linux driver ftdi_sio; descriptors as in the kernel's Documentation/usb/functionfs.rst.
#include "tests/vm/ftdi_gadget.hpp"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <poll.h>
#include <sys/mount.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>

namespace orcart::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGadget = "/sys/kernel/config/usb_gadget/orcart";
constexpr const char* kFunction = "/run/orcart-ffs";
constexpr std::size_t kPacket = 64, kStatus = 2;  // full speed
constexpr auto kPause = 5ms;

struct Interface {
  usb_interface_descriptor interface;
  usb_endpoint_descriptor_no_audio in, out;
} __attribute__((packed));
struct Descriptors {
  usb_functionfs_descs_head_v2 head;
  __le32 full_speed_count;
  Interface full_speed;
} __attribute__((packed));
struct Strings {
  usb_functionfs_strings_head head;
  __le16 language;
  char name[8];
} __attribute__((packed));

usb_endpoint_descriptor_no_audio bulk(std::uint8_t address) {
  return {.bLength = sizeof(usb_endpoint_descriptor_no_audio),
          .bDescriptorType = USB_DT_ENDPOINT,
          .bEndpointAddress = address,
          .bmAttributes = USB_ENDPOINT_XFER_BULK,
          .wMaxPacketSize = kPacket,
          .bInterval = 0};
}

Descriptors descriptors() {
  Descriptors all{};
  all.head = {.magic = FUNCTIONFS_DESCRIPTORS_MAGIC_V2,
              .length = sizeof(Descriptors),
              .flags = FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_ALL_CTRL_RECIP};
  all.full_speed_count = 3;
  all.full_speed.interface = {.bLength = sizeof(usb_interface_descriptor),
                              .bDescriptorType = USB_DT_INTERFACE,
                              .bInterfaceNumber = 0,
                              .bAlternateSetting = 0,
                              .bNumEndpoints = 2,
                              .bInterfaceClass = USB_CLASS_VENDOR_SPEC,
                              .bInterfaceSubClass = 0xFF,
                              .bInterfaceProtocol = 0xFF,
                              .iInterface = 1};
  all.full_speed.in = bulk(0x81);
  all.full_speed.out = bulk(0x02);
  return all;
}

Strings strings() {
  return {
      .head = {.magic = FUNCTIONFS_STRINGS_MAGIC, .length = sizeof(Strings), .str_count = 1, .lang_count = 1},
      .language = 0x0409,
      .name = "FT232R "};
}

bool put(const fs::path& file, const char* text) {
  std::ofstream out(file);
  out << text << std::flush;
  return out.good();
}

bool describe_device() {
  std::error_code error;
  const fs::path gadget(kGadget);
  for (const char* folder : {"strings/0x409", "configs/c.1", "functions/ffs.tracker"})
    fs::create_directories(gadget / folder, error);
  if (error || !put(gadget / "idVendor", "0x0403") || !put(gadget / "idProduct", "0x6001") ||
      !put(gadget / "bcdDevice", "0x0600") || !put(gadget / "strings/0x409/serialnumber", "ORCART1") ||
      !put(gadget / "strings/0x409/product", "FT232R USB UART") ||
      !put(gadget / "strings/0x409/manufacturer", "orcart"))
    return false;
  fs::create_directory_symlink(gadget / "functions/ffs.tracker", gadget / "configs/c.1/ffs.tracker", error);
  fs::create_directories(kFunction, error);
  return ::mount("tracker", kFunction, "functionfs", 0, nullptr) == 0;
}

template <class Block>
bool write_whole(int fd, const Block& block) {
  return ::write(fd, &block, sizeof(block)) == static_cast<ssize_t>(sizeof(block));
}

// The divisor counts in eighths; how those are coded is the chip's (FTDI's AN232B-05).
std::uint32_t baud_of(std::uint32_t divisor) {
  constexpr std::array<std::uint32_t, 8> kEighths{0, 4, 2, 1, 3, 5, 6, 7};
  if (divisor == 0) return 3'000'000;
  if (divisor == 1) return 2'000'000;
  return 24'000'000 / (8 * (divisor & 0x3FFF) + kEighths[divisor >> 14 & 7]);
}

bool about_equal(std::uint32_t a, std::uint32_t b) {
  return a < b + b / 33 && b < a + a / 33;
}

}  // namespace

FtdiGadget::FtdiGadget() : tracker_({.on_at = clock_.now()}, motion_) {}

Result<std::unique_ptr<FtdiGadget>> FtdiGadget::create() {
  if (!describe_device())
    return fail("the USB gadget cannot be described: is configfs mounted, and usb_f_fs loaded?");
  std::unique_ptr<FtdiGadget> gadget(new FtdiGadget);
  const std::string folder(kFunction);
  gadget->control_ = FileDescriptor(::open((folder + "/ep0").c_str(), O_RDWR | O_CLOEXEC));
  if (!gadget->control_.valid() || !write_whole(gadget->control_.get(), descriptors()) ||
      !write_whole(gadget->control_.get(), strings()))
    return fail("FunctionFS refuses the bridge's descriptors");
  // Not blocking concerns an endpoint that is not enabled; a transfer under way is waited for all the same.
  gadget->in_ = FileDescriptor(::open((folder + "/ep1").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  gadget->out_ = FileDescriptor(::open((folder + "/ep2").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!gadget->in_.valid() || !gadget->out_.valid()) return fail("FunctionFS made no endpoints");
  gadget->threads_.emplace_back([g = gadget.get()] { g->control(); });
  gadget->threads_.emplace_back([g = gadget.get()] { g->to_tracker(); });
  gadget->threads_.emplace_back([g = gadget.get()] { g->from_tracker(); });
  if (!put(fs::path(kGadget) / "UDC", "dummy_udc.0")) return fail("dummy_udc.0 does not take the gadget");
  return gadget;
}

FtdiGadget::~FtdiGadget() {
  over_.store(true, std::memory_order_relaxed);
  put(fs::path(kGadget) / "UDC", "\n");  // ends every transfer
  for (std::thread& thread : threads_) thread.join();
}

void FtdiGadget::control() {
  while (!over()) {
    pollfd watched{.fd = control_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&watched, 1, 50) <= 0) continue;
    usb_functionfs_event event{};
    if (::read(control_.get(), &event, sizeof(event)) != sizeof(event)) continue;
    if (event.type == FUNCTIONFS_SETUP) answer(event.u.setup);
  }
}

void FtdiGadget::answer(const usb_ctrlrequest& request) {
  constexpr std::uint8_t kGetStatus = 5, kGetLatency = 10;
  if ((request.bRequestType & USB_DIR_IN) == 0) {
    obey(request.bRequest, request.wValue, request.wIndex);
    (void)!::read(control_.get(), nullptr, 0);  // acknowledges it
    return;
  }
  std::array<std::uint8_t, 64> reply{};
  if (request.bRequest == kGetStatus) reply = {0x01, 0x60};
  if (request.bRequest == kGetLatency)
    reply[0] = static_cast<std::uint8_t>(latency_ms_.load(std::memory_order_relaxed));
  (void)!::write(control_.get(), reply.data(), std::min<std::size_t>(request.wLength, reply.size()));
}

void FtdiGadget::obey(std::uint8_t request, std::uint16_t value, std::uint16_t index) {
  constexpr std::uint8_t kSetBaud = 3, kSetData = 4, kSetLatency = 9;
  constexpr std::uint16_t kBreak = 1 << 14;
  if (request == kSetLatency)
    latency_ms_.store(std::clamp<int>(value & 0xFF, 1, 255), std::memory_order_relaxed);
  const std::lock_guard lock(tracker_mutex_);
  if (request == kSetBaud) {
    baud_ = baud_of(value | static_cast<std::uint32_t>(index & 1) << 16);
    highest_baud_.store(std::max(highest_baud_.load(std::memory_order_relaxed), baud_),
                        std::memory_order_relaxed);
  }
  if (request == kSetData) {
    const bool was_in_break = std::exchange(in_break_, (value & kBreak) != 0);
    if (was_in_break && !in_break_) tracker_.receive_break(clock_.now());
  }
}

void FtdiGadget::to_tracker() {
  std::array<std::byte, kPacket> packet{};
  while (!over()) {
    const ssize_t got = ::read(out_.get(), packet.data(), packet.size());
    if (got <= 0) {
      clock_.sleep_until(clock_.now() + kPause);
      continue;
    }
    const std::lock_guard lock(tracker_mutex_);
    const Instant now = clock_.now();
    if (about_equal(tracker_.baud(now), baud_))
      tracker_.receive(std::span(packet).first(static_cast<std::size_t>(got)), now);
    else
      tracker_.receive_noise();
  }
}

void FtdiGadget::from_tracker() {
  std::array<std::byte, kPacket - kStatus> bytes{};
  std::array<std::byte, kPacket> packet{std::byte{0x01}, std::byte{0x60}};
  while (!over()) {
    std::size_t count = 0;
    {
      const std::lock_guard lock(tracker_mutex_);
      const Instant now = clock_.now();
      count = tracker_.read(bytes, now);
      if (!about_equal(tracker_.baud(now), baud_)) std::fill_n(bytes.begin(), count, std::byte{0xA5});
    }
    std::copy_n(bytes.begin(), count, packet.begin() + kStatus);
    if (::write(in_.get(), packet.data(), kStatus + count) < 0) {
      clock_.sleep_until(clock_.now() + kPause);
      continue;
    }
    (count == 0 ? idle_packets_ : full_packets_).fetch_add(1, std::memory_order_relaxed);
    if (count < bytes.size())
      clock_.sleep_until(clock_.now() + Nanos{1ms} * latency_ms_.load(std::memory_order_relaxed));
  }
}

}  // namespace orcart::testing
