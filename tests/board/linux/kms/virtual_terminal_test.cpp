// The terminal is taken in order and given back as it was, whatever fails on the way.
#include "board/linux/kms/virtual_terminal.hpp"

#include <linux/kd.h>
#include <linux/vt.h>

#include <cerrno>
#include <cstdint>

#include <gtest/gtest.h>

namespace orcart {
namespace {

struct PlayedConsole final : DeviceCalls {
  int open(const char*, int) noexcept override {
    if (open_error != 0) return open_error;
    ++opened;
    return 3;
  }
  void close(int) noexcept override { ++closed; }
  int control(int, unsigned long request, void* argument) noexcept override {
    const auto value = static_cast<int>(reinterpret_cast<std::intptr_t>(argument));
    switch (request) {
      case VT_GETSTATE:
        if (state_error != 0) return state_error;
        static_cast<vt_stat*>(argument)->v_active = static_cast<unsigned short>(front);
        return 0;
      case KDGETMODE:
        *static_cast<int*>(argument) = mode;
        return 0;
      case KDGKBMODE:
        *static_cast<int*>(argument) = keyboard;
        return 0;
      case VT_ACTIVATE:
        front = value;
        return 0;
      case KDSKBMODE:
        keyboard = value;
        return 0;
      case KDSETMODE:
        if (value == KD_GRAPHICS && graphics_error != 0) return graphics_error;
        mode = value;
        return 0;
      default:
        return 0;
    }
  }
  std::int64_t read(int, void*, std::size_t) noexcept override { return 0; }
  void* map(int, std::size_t, std::uint64_t) noexcept override { return nullptr; }
  void unmap(void*, std::size_t) noexcept override {}
  int wait(int, short, Instant) noexcept override { return 0; }

  int open_error = 0, state_error = 0, graphics_error = 0;
  int front = 1, mode = KD_TEXT, keyboard = K_UNICODE;
  int opened = 0, closed = 0;
};

TEST(VirtualTerminal, ComesToTheFrontInGraphicsModeAndGivesEverythingBack) {
  PlayedConsole console;
  {
    const auto terminal = VirtualTerminal::take("/dev/tty7", console);
    ASSERT_TRUE(terminal);
    EXPECT_EQ(console.front, 7);
    EXPECT_EQ(console.mode, KD_GRAPHICS);
    EXPECT_EQ(console.keyboard, K_OFF);
  }
  EXPECT_EQ(console.front, 1);
  EXPECT_EQ(console.mode, KD_TEXT);
  EXPECT_EQ(console.keyboard, K_UNICODE);
  EXPECT_EQ(console.opened, console.closed);
}

TEST(VirtualTerminal, GivesBackWhatItChangedWhenTheLastStepFails) {
  PlayedConsole console;
  console.graphics_error = -EPERM;
  EXPECT_FALSE(VirtualTerminal::take("/dev/tty7", console));
  EXPECT_EQ(console.front, 1);
  EXPECT_EQ(console.keyboard, K_UNICODE);
  EXPECT_EQ(console.opened, console.closed);
}

TEST(VirtualTerminal, RefusesInASentence) {
  PlayedConsole console;
  EXPECT_NE(VirtualTerminal::take("/dev/pts/0", console).error().message.find("/dev/tty63"),
            std::string::npos);
  console.open_error = -EACCES;
  EXPECT_NE(VirtualTerminal::take("/dev/tty7", console).error().message.find("TTYPath"), std::string::npos);
  console.open_error = 0;
  console.state_error = -ENOTTY;
  EXPECT_FALSE(VirtualTerminal::take("/dev/tty7", console));
  EXPECT_EQ(console.mode, KD_TEXT);
  EXPECT_EQ(console.opened, console.closed);
}

}  // namespace
}  // namespace orcart
