// libgpiod 2.x: edges carry the kernel's monotonic stamp and its number of the line's edges.
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

template <class T, void (*Free)(T*)>
struct FreeBy {
  void operator()(T* object) const noexcept { Free(object); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, FreeBy<T, Free>>;
using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using ChipInfo = Owned<gpiod_chip_info, gpiod_chip_info_free>;
using LineInfo = Owned<gpiod_line_info, gpiod_line_info_free>;
using LineSettings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;
using LineRequest = Owned<gpiod_line_request, gpiod_line_request_release>;
using EventBuffer = Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free>;

gpiod_line_bias bias_of(LineBias bias) {
  switch (bias) {
    case LineBias::pull_up:
      return GPIOD_LINE_BIAS_PULL_UP;
    case LineBias::pull_down:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case LineBias::disabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case LineBias::as_is:
      break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

std::vector<std::string> chip_paths() {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error))
    if (entry.path().filename().string().starts_with("gpiochip")) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

/// By path, by name or by label, as version 1 looked it up.
Chip open_chip(const std::string& wanted) {
  if (wanted.starts_with('/')) return Chip(gpiod_chip_open(wanted.c_str()));
  for (const std::string& path : chip_paths()) {
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) continue;
    const ChipInfo info(gpiod_chip_get_info(chip.get()));
    if (info &&
        (wanted == gpiod_chip_info_get_name(info.get()) || wanted == gpiod_chip_info_get_label(info.get())))
      return chip;
  }
  errno = ENOENT;
  return nullptr;
}

int offset_of(gpiod_chip* chip, const std::string& name) {
  int number = 0;
  const char* end = name.data() + name.size();
  if (const auto read = std::from_chars(name.data(), end, number); read.ec == std::errc{} && read.ptr == end)
    return number;
  return gpiod_chip_get_line_offset_from_name(chip, name.c_str());
}

LineRequest request_line(gpiod_chip* chip, int offset, const LineSettings& settings) {
  const LineConfig config(gpiod_line_config_new());
  const RequestConfig request(gpiod_request_config_new());
  if (!config || !request || !settings) return nullptr;
  gpiod_request_config_set_consumer(request.get(), "orcart pedal");
  const auto line = static_cast<unsigned>(offset);
  if (gpiod_line_config_add_line_settings(config.get(), &line, 1, settings.get()) < 0) return nullptr;
  return LineRequest(gpiod_chip_request_lines(chip, request.get(), config.get()));
}

class GpiodLines final : public RequestedLines {
 public:
  GpiodLines(LineRequest pedal, int pedal_offset, LineRequest trigger, int trigger_offset)
      : pedal_(std::move(pedal)),
        trigger_(std::move(trigger)),
        pedal_offset_(static_cast<unsigned>(pedal_offset)),
        trigger_offset_(static_cast<unsigned>(trigger_offset)),
        fd_(gpiod_line_request_get_fd(pedal_.get())),
        events_(gpiod_edge_event_buffer_new(1)) {}

  Result<RawEdge, PortFault> read() noexcept override {
    pollfd watched{.fd = fd_, .events = POLLIN, .revents = 0};
    if (::poll(&watched, 1, 0) <= 0) return tl::unexpected(PortFault::nothing_yet);
    if ((watched.revents & POLLIN) == 0) return tl::unexpected(PortFault::disconnected);
    if (gpiod_line_request_read_edge_events(pedal_.get(), events_.get(), 1) < 1)
      return tl::unexpected(errno == EAGAIN ? PortFault::nothing_yet : PortFault::disconnected);
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(events_.get(), 0);
    const bool rising = gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE;
    return RawEdge{
        .kind = rising ? EdgeKind::pressed : EdgeKind::released,
        .at = instant_from_nanos(static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event))),
        .number = static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event))};
  }
  Result<EdgeKind, PortFault> level() noexcept override {
    const auto value = gpiod_line_request_get_value(pedal_.get(), pedal_offset_);
    if (value == GPIOD_LINE_VALUE_ERROR) return tl::unexpected(PortFault::disconnected);
    return value == GPIOD_LINE_VALUE_ACTIVE ? EdgeKind::pressed : EdgeKind::released;
  }
  Result<void, PortFault> set_trigger(TriggerLevel level) noexcept override {
    if (!trigger_) return tl::unexpected(PortFault::unsupported);
    const auto value = level == TriggerLevel::raised ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(trigger_.get(), trigger_offset_, value) < 0)
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
  LineRequest pedal_, trigger_;
  unsigned pedal_offset_, trigger_offset_;
  int fd_;
  EventBuffer events_;
};

class KernelLines final : public LineKeeper {
 public:
  Result<std::unique_ptr<RequestedLines>, GpioTrouble> request(const GpioWish& wish) noexcept override {
    const Chip chip = open_chip(wish.chip);
    if (!chip) return refused("chip " + wish.chip);
    const std::string pedal_name = "line " + wish.line + " of " + wish.chip;
    const int pedal_offset = offset_of(chip.get(), wish.line);
    if (pedal_offset < 0) return tl::unexpected(gpio_trouble(pedal_name, ENOENT));
    const LineSettings pedal_settings(gpiod_line_settings_new());
    gpiod_line_settings_set_edge_detection(pedal_settings.get(), GPIOD_LINE_EDGE_BOTH);
    gpiod_line_settings_set_event_clock(pedal_settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
    gpiod_line_settings_set_bias(pedal_settings.get(), bias_of(wish.bias));
    gpiod_line_settings_set_active_low(pedal_settings.get(), wish.pressed == ActiveLevel::low);
    LineRequest pedal = request_line(chip.get(), pedal_offset, pedal_settings);
    if (!pedal) return refused(pedal_name);
    LineRequest trigger;
    int trigger_offset = 0;
    if (!wish.trigger_line.empty()) {
      const std::string name = "trigger line " + wish.trigger_line + " of " + wish.chip;
      trigger_offset = offset_of(chip.get(), wish.trigger_line);
      if (trigger_offset < 0) return tl::unexpected(gpio_trouble(name, ENOENT));
      const LineSettings settings(gpiod_line_settings_new());
      gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
      gpiod_line_settings_set_active_low(settings.get(), wish.raised == ActiveLevel::low);
      trigger = request_line(chip.get(), trigger_offset, settings);
      if (!trigger) return refused(name);
    }
    return std::make_unique<GpiodLines>(std::move(pedal), pedal_offset, std::move(trigger), trigger_offset);
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
  for (const std::string& path : chip_paths()) {
    GpioChipFacts facts{.path = path};
    const Chip chip(gpiod_chip_open(path.c_str()));
    const ChipInfo info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (info) {
      facts.name = gpiod_chip_info_get_name(info.get());
      facts.label = gpiod_chip_info_get_label(info.get());
      for (unsigned i = 0; i < gpiod_chip_info_get_num_lines(info.get()); ++i) {
        const LineInfo line(gpiod_chip_get_line_info(chip.get(), i));
        if (!line) continue;
        const char* name = gpiod_line_info_get_name(line.get());
        const char* consumer = gpiod_line_info_get_consumer(line.get());
        facts.lines.push_back({i, name == nullptr ? "" : name, consumer == nullptr ? "" : consumer});
      }
    } else {
      facts.trouble = gpio_trouble("chip " + path, errno).sentence;
    }
    chips.push_back(std::move(facts));
  }
  return chips;
}

}  // namespace orcart
