// libgpiod 1.6: edges carry the kernel's monotonic stamp (since Linux 5.7) and no number.
#include <gpiod.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>

#include "board/linux/byte_stream.hpp"
#include "board/linux/pedal/requested_lines.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {
namespace {

constexpr const char* kConsumer = "orcart pedal";

struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

int bias_flag(LineBias bias) {
  switch (bias) {
    case LineBias::pull_up:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case LineBias::pull_down:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    case LineBias::disabled:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    case LineBias::as_is:
      break;
  }
  return 0;
}

int active_flag(ActiveLevel level) {
  return level == ActiveLevel::low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
}

gpiod_line* line_of(gpiod_chip* chip, const std::string& name) {
  unsigned number = 0;
  const char* end = name.data() + name.size();
  if (const auto read = std::from_chars(name.data(), end, number); read.ec == std::errc{} && read.ptr == end)
    return gpiod_chip_get_line(chip, number);
  return gpiod_chip_find_line(chip, name.c_str());
}

PortFault fault_of_errno() {
  return errno == EAGAIN ? PortFault::nothing_yet : PortFault::disconnected;
}

class GpiodLines final : public RequestedLines {
 public:
  GpiodLines(Chip chip, gpiod_line* pedal, gpiod_line* trigger)
      : chip_(std::move(chip)), pedal_(pedal), trigger_(trigger), fd_(gpiod_line_event_get_fd(pedal)) {}

  Result<RawEdge, PortFault> read() noexcept override {
    pollfd watched{.fd = fd_, .events = POLLIN, .revents = 0};
    if (::poll(&watched, 1, 0) <= 0) return tl::unexpected(PortFault::nothing_yet);
    if ((watched.revents & POLLIN) == 0) return tl::unexpected(PortFault::disconnected);
    gpiod_line_event event{};
    if (gpiod_line_event_read_fd(fd_, &event) < 0) return tl::unexpected(fault_of_errno());
    return RawEdge{
        .kind = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE ? EdgeKind::pressed : EdgeKind::released,
        .at = instant_from_nanos(std::int64_t{event.ts.tv_sec} * 1'000'000'000 + event.ts.tv_nsec),
        .number = std::nullopt};
  }
  Result<EdgeKind, PortFault> level() noexcept override {
    const int value = gpiod_line_get_value(pedal_);
    if (value < 0) return tl::unexpected(PortFault::disconnected);
    return value == 1 ? EdgeKind::pressed : EdgeKind::released;
  }
  Result<void, PortFault> set_trigger(TriggerLevel level) noexcept override {
    if (trigger_ == nullptr) return tl::unexpected(PortFault::unsupported);
    if (gpiod_line_set_value(trigger_, level == TriggerLevel::raised ? 1 : 0) < 0)
      return tl::unexpected(PortFault::disconnected);
    return {};
  }
  bool wait(Instant deadline) noexcept override {
    const std::int64_t left = std::max<std::int64_t>(0, (deadline - RealClock{}.now()).count());
    const timespec timeout{.tv_sec = left / 1'000'000'000, .tv_nsec = left % 1'000'000'000};
    pollfd watched{.fd = fd_, .events = POLLIN, .revents = 0};
    return ::ppoll(&watched, 1, &timeout, nullptr) > 0;
  }

 private:
  Chip chip_;  ///< closing it gives the lines back
  gpiod_line* pedal_;
  gpiod_line* trigger_;
  int fd_;
};

class KernelLines final : public LineKeeper {
 public:
  Result<std::unique_ptr<RequestedLines>, GpioTrouble> request(const GpioWish& wish) noexcept override {
    Chip chip(gpiod_chip_open_lookup(wish.chip.c_str()));
    if (!chip) return refused("chip " + wish.chip);
    gpiod_line* pedal = line_of(chip.get(), wish.line);
    const std::string pedal_name = "line " + wish.line + " of " + wish.chip;
    if (pedal == nullptr) return tl::unexpected(gpio_trouble(pedal_name, ENOENT));
    if (gpiod_line_request_both_edges_events_flags(pedal, kConsumer,
                                                   bias_flag(wish.bias) | active_flag(wish.pressed)) < 0)
      return refused(pedal_name);
    gpiod_line* trigger = nullptr;
    if (!wish.trigger_line.empty()) {
      const std::string name = "trigger line " + wish.trigger_line + " of " + wish.chip;
      trigger = line_of(chip.get(), wish.trigger_line);
      if (trigger == nullptr) return tl::unexpected(gpio_trouble(name, ENOENT));
      if (gpiod_line_request_output_flags(trigger, kConsumer, active_flag(wish.raised), 0) < 0)
        return refused(name);
    }
    return std::make_unique<GpiodLines>(std::move(chip), pedal, trigger);
  }

 private:
  static tl::unexpected<GpioTrouble> refused(const std::string& what) {
    return tl::unexpected(gpio_trouble(what, errno));
  }
};

}  // namespace

LineKeeper& kernel_lines() noexcept {
  static KernelLines lines;
  return lines;
}

std::vector<GpioChipFacts> gpio_chips() {
  std::vector<GpioChipFacts> chips;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const std::string path = entry.path();
    if (!entry.path().filename().string().starts_with("gpiochip")) continue;
    GpioChipFacts facts{.path = path};
    if (const Chip chip(gpiod_chip_open(path.c_str())); chip) {
      facts.name = gpiod_chip_name(chip.get());
      facts.label = gpiod_chip_label(chip.get());
      for (unsigned i = 0; i < gpiod_chip_num_lines(chip.get()); ++i) {
        gpiod_line* line = gpiod_chip_get_line(chip.get(), i);
        if (line == nullptr) continue;
        const char* name = gpiod_line_name(line);
        const char* consumer = gpiod_line_consumer(line);
        facts.lines.push_back({i, name == nullptr ? "" : name, consumer == nullptr ? "" : consumer});
      }
    } else {
      facts.trouble = gpio_trouble("chip " + path, errno).sentence;
    }
    chips.push_back(std::move(facts));
  }
  std::ranges::sort(chips, {}, &GpioChipFacts::path);
  return chips;
}

}  // namespace orcart
