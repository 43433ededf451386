// A bought pedal over a played evdev device: grabbed, stamped, its queue overflowing, pulled out and put
// back.
#include "board/linux/pedal/keyboard_pedal.hpp"

#include <cerrno>

#include <gtest/gtest.h>

#include "tests/board/linux/played_input.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart::testing {
namespace {

struct PlayedKeyboard final : PlayedInput {
  using PlayedInput::PlayedInput;
  int ask(unsigned long request, void* argument) noexcept override {
    auto* bits = static_cast<std::uint8_t*>(argument);
    const bool state = _IOC_NR(request) == _IOC_NR(EVIOCGKEY(0));
    if (!state || down) bits[KEY_B / 8] = static_cast<std::uint8_t>(bits[KEY_B / 8] | 1U << (KEY_B % 8));
    return 0;
  }

  bool down = false;
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
