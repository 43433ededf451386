// Counts between two reports of the kernel are one reading.
#include "board/linux/encoder/evdev_encoder.hpp"

#include <linux/input.h>

#include <cerrno>

#include "board/linux/byte_stream.hpp"
#include "board/linux/input_device.hpp"

namespace orcart {
namespace {

template <std::size_t kCount>
using Bits = std::array<std::uint8_t, kCount / 8 + 1>;
using AxisBits = Bits<ABS_CNT>;  // relative axes are fewer
using KeyBits = Bits<KEY_CNT>;

template <std::size_t kSize>
bool has(const std::array<std::uint8_t, kSize>& bits, std::uint16_t code) {
  return (bits[code / 8] >> (code % 8) & 1) != 0;
}

std::uint16_t event_type_of(AxisKind kind) {
  return kind == AxisKind::relative ? EV_REL : EV_ABS;
}

/// The axes of a kind that the device has, or a negative error number.
int ask_axes(const OpenDevice& device, AxisKind kind, AxisBits& axes) noexcept {
  return kind == AxisKind::relative ? device.control(EVIOCGBIT(EV_REL, axes.size()), axes.data())
                                    : device.control(EVIOCGBIT(EV_ABS, axes.size()), axes.data());
}

std::vector<std::string> axes_of(const OpenDevice& device) {
  std::vector<std::string> names;
  for (const AxisKind kind : {AxisKind::relative, AxisKind::absolute}) {
    AxisBits axes{};
    if (ask_axes(device, kind, axes) < 0) continue;
    for (std::uint16_t code = 0; code < ABS_CNT; ++code)
      if (has(axes, code))
        if (std::string name = name_of_axis({kind, code}); !name.empty()) names.push_back(std::move(name));
  }
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

std::string node_of(const std::string& device) {
  return device.starts_with("event") ? "/dev/input/" + device : device;
}

}  // namespace

Result<std::unique_ptr<EvdevEncoder>> EvdevEncoder::open(const EncoderWish& wish, const Clock& clock,
                                                         DeviceCalls& calls) {
  const auto axis = encoder_axis_of(wish.axis);
  if (!axis)
    return fail("encoder axis \"" + wish.axis + "\" is unknown; " + known_axes() + " would be accepted");
  std::unique_ptr<EvdevEncoder> encoder(
      new EvdevEncoder(node_of(wish.device), wish.axis, *axis, clock, calls));
  if (auto opened = encoder->open_device(); !opened) return tl::unexpected(opened.error());
  return encoder;
}

Result<void> EvdevEncoder::open_device() {
  const auto refused = [&](int error) { return fail(input_trouble("encoder", node_, error)); };
  const Instant began = clock_.now();  // before any event that this opening may bring
  auto device = open_input(calls_, node_);
  if (!device) return refused(device.error());
  AxisBits axes{};
  if (const int answer = ask_axes(*device, axis_.kind, axes); answer < 0) return refused(answer);
  if (!has(axes, axis_.code)) {
    const std::string there = joined(axes_of(*device));
    return fail("encoder " + node_ + " has no axis \"" + axis_name_ + "\"; " +
                (there.empty() ? "an input device that turns (orcart probe lists them)" : there) +
                " would be accepted");
  }
  if (const int answer = take_over(*device); answer < 0) return refused(answer);
  device_ = std::move(*device);
  counts_ = 0;
  if (!ask_where_it_stands()) {
    device_.reset();
    return refused(-ENODEV);
  }
  moved_ = dropped_ = false;
  begin_run(began);
  return {};
}

/// A relative axis cannot be asked.
bool EvdevEncoder::ask_where_it_stands() noexcept {
  if (axis_.kind == AxisKind::relative) return true;
  input_absinfo info{};
  if (device_.control(EVIOCGABS(axis_.code), &info) < 0) return false;
  counts_ = info.value;
  return true;
}

void EvdevEncoder::begin_run(Instant at) noexcept {
  ++run_;
  keep(at);
}

void EvdevEncoder::keep(Instant at) noexcept {
  readings_[(first_ + count_) % readings_.size()] = {.at = at, .counts = counts_, .run = run_};
  ++count_;
}

void EvdevEncoder::lose_device() noexcept {
  device_.reset();
  retry_at_ = clock_.now() + kRetry;
}

// SYN_DROPPED: the kernel's queue overflowed. What comes until the next report is part of what was lost; an
// absolute axis is then asked where it stands, of a relative one nobody knows how far it went.
void EvdevEncoder::accept(std::uint16_t type, std::uint16_t code, std::int32_t value, Instant at) noexcept {
  if (type == EV_SYN && code == SYN_DROPPED) {
    dropped_ = true;
  } else if (type == EV_SYN && code == SYN_REPORT) {
    if (dropped_) {
      (void)ask_where_it_stands();  // where that fails, the next read finds the device gone
      begin_run(at);
    } else if (moved_) {
      keep(at);
    }
    moved_ = dropped_ = false;
  } else if (!dropped_ && type == event_type_of(axis_.kind) && code == axis_.code) {
    counts_ = axis_.kind == AxisKind::relative ? counts_ + value : value;
    moved_ = true;
  }
}

Result<void, PortFault> EvdevEncoder::read_more() noexcept {
  std::array<input_event, 32> events{};
  const auto count = read_events(device_, events);
  if (!count) {
    if (count.error() == PortFault::disconnected) lose_device();
    return tl::unexpected(count.error());
  }
  for (std::size_t i = 0; i < *count; ++i)
    accept(events[i].type, events[i].code, events[i].value, stamp_of(events[i]));
  return {};
}

Result<EncoderReading, PortFault> EvdevEncoder::take_reading() noexcept {
  for (int i = 0; i < 64 && count_ == 0; ++i) {  // events of other axes make empty rounds
    if (!device_.valid()) {
      if (clock_.now() < retry_at_) return tl::unexpected(PortFault::disconnected);
      if (!open_device()) {
        retry_at_ = clock_.now() + kRetry;
        return tl::unexpected(PortFault::disconnected);
      }
    } else if (auto more = read_more(); !more) {
      return tl::unexpected(more.error());
    }
  }
  if (count_ == 0) return tl::unexpected(PortFault::nothing_yet);
  const EncoderReading reading = readings_[first_];
  first_ = (first_ + 1) % readings_.size();
  --count_;
  return reading;
}

std::vector<EncoderFacts> encoders() {
  std::vector<EncoderFacts> all;
  for (const std::string& node : input_nodes()) {
    const auto device = open_input(system_calls(), node);
    if (!device) continue;  // told among the pedals
    KeyBits keys{};
    (void)device->control(EVIOCGBIT(EV_KEY, keys.size()), keys.data());
    if (has(keys, BTN_LEFT) || has(keys, BTN_TOUCH) || has(keys, BTN_TOOL_PEN)) continue;
    EncoderFacts facts{.path = node, .name = input_name(*device), .axes = axes_of(*device)};
    if (!facts.axes.empty()) all.push_back(std::move(facts));
  }
  return all;
}

}  // namespace orcart
