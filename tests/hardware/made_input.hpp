// An input device made of nothing, by the kernel's uinput.
#pragma once

#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "realtime/kernel/clock.hpp"

namespace orcart::testing {

/// It is there until the end of its life, then it is pulled out. One thread.
class MadeInput {
 public:
  /// `equip(fd)` says what it has, by UI_SET_...; waits up to 5 s for its node.
  template <class Equip>
  MadeInput(const std::string& uinput, const char* name, const Equip& equip)
      : fd_(::open(uinput.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)) {
    equip(fd_);
    uinput_setup setup{};
    setup.id = {.bustype = BUS_USB, .vendor = 0x1, .product = 0x1, .version = 1};
    std::snprintf(setup.name, sizeof setup.name, "%s", name);
    ::ioctl(fd_, UI_DEV_SETUP, &setup);
    ::ioctl(fd_, UI_DEV_CREATE);
    char folder[64] = "";
    ::ioctl(fd_, UI_GET_SYSNAME(sizeof folder), folder);
    std::error_code error;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string("/sys/devices/virtual/input/") + folder, error))
      if (entry.path().filename().string().starts_with("event"))
        node_ = "/dev/input/" + entry.path().filename().string();
    RealClock clock;
    const Instant patience = clock.now() + 5s;
    while (!std::filesystem::exists(node_) && clock.now() < patience) clock.sleep_until(clock.now() + 10ms);
  }
  MadeInput(MadeInput&& other) noexcept : fd_(std::exchange(other.fd_, -1)), node_(std::move(other.node_)) {}
  MadeInput& operator=(MadeInput&&) = delete;
  ~MadeInput() {
    if (fd_ >= 0) ::close(fd_);
  }

  const std::string& node() const { return node_; }
  /// One event and its report.
  void event(std::uint16_t type, std::uint16_t code, std::int32_t value) const {
    input_event events[2]{};
    events[0].type = type;
    events[0].code = code;
    events[0].value = value;
    events[1].type = EV_SYN;
    EXPECT_EQ(::write(fd_, events, sizeof events), static_cast<ssize_t>(sizeof events));
  }

 private:
  int fd_;
  std::string node_;
};

}  // namespace orcart::testing
