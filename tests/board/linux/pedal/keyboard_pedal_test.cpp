// A bought pedal over a played evdev device: grabbed, stamped, its queue overflowing, pulled out and put
// back.
#include "board/linux/pedal/keyboard_pedal.hpp"

#include <linux/input.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

struct PlayedKeyboard final : DeviceCalls {
  explicit PlayedKeyboard(SimulatedClock& c) : clock(c) {}

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
    auto* bits = static_cast<std::uint8_t*>(argument);
    const bool state = _IOC_NR(request) == _IOC_NR(EVIOCGKEY(0));
    if (!state || down) bits[KEY_B / 8] = static_cast<std::uint8_t>(bits[KEY_B / 8] | 1U << (KEY_B % 8));
    return 0;
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
  bool down = false, grabbed = false;
};

class KeyboardPedalTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = KeyboardPedal::open({.device = "/dev/input/event5", .key = "b"}, clock, keyboard);
    ASSERT_TRUE(made) << made.error().message;
    pedal = std::move(*made);
  }
  std::string refusal(const std::string& key = "b") {
    auto made = KeyboardPedal::open({.device = "/dev/input/event5", .key = key}, clock, keyboard);
    return made ? "" : made.error().message;
  }

  SimulatedClock clock;
  PlayedKeyboard keyboard{clock};
  std::unique_ptr<KeyboardPedal> pedal;
};

TEST_F(KeyboardPedalTest, GrabsTheKeyboardAndAsksForTheMonotonicClock) {
  EXPECT_TRUE(keyboard.grabbed);
  EXPECT_EQ(keyboard.clock_id, CLOCK_MONOTONIC);
  pedal.reset();
  EXPECT_EQ(keyboard.opened, keyboard.closed);
}

TEST_F(KeyboardPedalTest, TurnsItsKeyIntoEdgesAndIgnoresRepeatsAndOtherKeys) {
  keyboard.event(EV_KEY, KEY_B, 1);
  keyboard.event(EV_SYN, SYN_REPORT, 0);
  keyboard.event(EV_KEY, KEY_B, 2);
  keyboard.event(EV_KEY, KEY_C, 1);
  keyboard.event(EV_KEY, KEY_B, 0);
  pedal->wait(clock.now() + 1s);
  const auto down = pedal->take_edge(), up = pedal->take_edge();
  ASSERT_TRUE(down && up);
  EXPECT_EQ(down->kind, EdgeKind::pressed);
  EXPECT_EQ(down->at, clock.now());
  EXPECT_EQ(down->sequence, 1u);
  EXPECT_EQ(up->kind, EdgeKind::released);
  EXPECT_EQ(up->sequence, 2u);
  EXPECT_EQ(pedal->take_edge().error(), PortFault::nothing_yet);
}

TEST_F(KeyboardPedalTest, LeavesAGapWhereTheKernelDroppedEvents) {
  keyboard.down = true;
  keyboard.event(EV_SYN, SYN_DROPPED, 0);
  const auto edge = pedal->take_edge();
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->kind, EdgeKind::pressed);
  EXPECT_EQ(edge->sequence, 2u);
}

TEST_F(KeyboardPedalTest, IsPulledOutAndPutBack) {
  keyboard.read_error = -ENODEV;
  keyboard.open_error = -ENOENT;
  EXPECT_EQ(pedal->take_edge().error(), PortFault::disconnected);
  EXPECT_EQ(keyboard.opened, keyboard.closed);
  const Instant deadline = clock.now() + 1s;
  pedal->wait(deadline);
  EXPECT_EQ(clock.now(), deadline);
  keyboard.read_error = keyboard.open_error = 0;
  pedal->wait(clock.now() + 300ms);
  EXPECT_TRUE(keyboard.grabbed);
  keyboard.event(EV_KEY, KEY_B, 1);
  EXPECT_EQ(pedal->take_edge()->sequence, 2u) << "what happened meanwhile nobody knows";
}

TEST_F(KeyboardPedalTest, RefusesInASentenceAndLeavesNothingOpen) {
  pedal.reset();
  keyboard.open_error = -EACCES;
  EXPECT_NE(refusal().find("group input"), std::string::npos);
  keyboard.open_error = 0;
  keyboard.grab_error = -EBUSY;
  EXPECT_NE(refusal().find("grabbed it"), std::string::npos);
  keyboard.grab_error = 0;
  EXPECT_NE(refusal("a").find("has no key \"a\""), std::string::npos);
  EXPECT_NE(refusal("pedal").find("space"), std::string::npos);
  EXPECT_EQ(keyboard.opened, keyboard.closed);
}

TEST_F(KeyboardPedalTest, KnowsKeysByNameAndByNumber) {
  EXPECT_EQ(key_code_of("f13"), KEY_F13);
  EXPECT_EQ(key_code_of("7"), KEY_7) << "one digit is the key that types it";
  EXPECT_EQ(key_code_of("183"), KEY_F13);
  EXPECT_FALSE(key_code_of("99999"));
  EXPECT_FALSE(key_code_of(""));
}

TEST_F(KeyboardPedalTest, AllocatesNothingWhileItRuns) {
  keyboard.event(EV_KEY, KEY_B, 1);
  EXPECT_TRUE(zero_allocation([&] {
    pedal->wait(clock.now() + 10ms);
    (void)pedal->take_edge();
    (void)pedal->take_edge();
  }));
}

}  // namespace
}  // namespace orcart::testing
