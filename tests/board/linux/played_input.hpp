// A played evdev device: what it has is the test's, what it says comes event by event.
#pragma once

#include <linux/input.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>

#include "board/linux/device_calls.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

struct PlayedInput : DeviceCalls {
  explicit PlayedInput(SimulatedClock& c) : clock(c) {}

  /// What the device has and where it stands: EVIOCGBIT, EVIOCGKEY, EVIOCGABS.
  virtual int ask(unsigned long request, void* argument) noexcept = 0;

  int open(const char*, int) noexcept override {
    if (open_error != 0) return open_error;
    ++opened;
    return 3;
  }
  void close(int) noexcept override {
    ++closed;
    grabbed = false;
  }
  int control(int, unsigned long request, void* argument) noexcept override {
    if (request == EVIOCGRAB) {
      if (grab_error == 0) grabbed = argument != nullptr;
      return grab_error;
    }
    if (request == EVIOCSCLOCKID) {
      clock_id = *static_cast<int*>(argument);
      return 0;
    }
    return ask(request, argument);
  }
  std::int64_t read(int, void* into, std::size_t size) noexcept override {
    if (read_error != 0) return read_error;
    const std::size_t count = std::min(size / sizeof(input_event), events.size());
    if (count == 0) return -EAGAIN;
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(static_cast<std::byte*>(into) + i * sizeof(input_event), &events.front(),
                  sizeof(input_event));
      events.pop_front();
    }
    return static_cast<std::int64_t>(count * sizeof(input_event));
  }
  void* map(int, std::size_t, std::uint64_t) noexcept override { return nullptr; }
  void unmap(void*, std::size_t) noexcept override {}
  int wait(int, short, Instant deadline) noexcept override {
    if (!events.empty() || read_error != 0) return POLLIN;
    clock.advance_to(deadline);
    return 0;
  }
  void event(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    const std::int64_t us = nanos_since_zero(clock.now()) / 1000;
    input_event item{};
    item.input_event_sec = us / 1'000'000;
    item.input_event_usec = us % 1'000'000;
    item.type = type;
    item.code = code;
    item.value = value;
    events.push_back(item);
  }

  SimulatedClock& clock;
  std::deque<input_event> events;
  int open_error = 0, grab_error = 0, read_error = 0, clock_id = -1;
  int opened = 0, closed = 0;
  bool grabbed = false;
};

}  // namespace orcart::testing
