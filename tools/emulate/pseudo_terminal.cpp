// A pseudo-terminal as the emulated tracker's line.
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "board/linux/tty_line.hpp"
#include "realtime/kernel/clock.hpp"
#include "tools/emulate/emulator_port.hpp"

namespace orcart {
namespace {

constexpr Nanos kNobodyThere = 5ms;

class PseudoTerminal final : public EmulatorPort {
 public:
  PseudoTerminal(FileDescriptor controller, std::string name) noexcept
      : controller_(std::move(controller)), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }

  void wait(Nanos time) override {
    const timespec timeout{.tv_sec = time / 1s, .tv_nsec = (time % 1s).count()};
    pollfd watched{.fd = controller_.get(), .events = POLLIN, .revents = 0};
    ::ppoll(&watched, 1, &timeout, nullptr);
    nobody_there_ = (watched.revents & POLLHUP) != 0;
    if (nobody_there_) RealClock{}.sleep_until(RealClock{}.now() + kNobodyThere);
  }
  std::size_t read(std::span<std::byte> into) override {
    const ssize_t count = ::read(controller_.get(), into.data(), into.size());
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  void write(std::span<const std::byte> bytes) override {
    // What a client does not read is lost, as on a line without flow control.
    if (!nobody_there_) (void)!::write(controller_.get(), bytes.data(), bytes.size());
  }
  std::uint32_t baud() override { return nobody_there_ ? 0 : tty_baud(controller_.get()); }

 private:
  FileDescriptor controller_;
  std::string name_;
  bool nobody_there_ = true;
};

}  // namespace

Result<std::unique_ptr<EmulatorPort>> open_pseudo_terminal() {
  FileDescriptor controller(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  const bool made = controller.valid() && ::grantpt(controller.get()) == 0 &&
                    ::unlockpt(controller.get()) == 0 &&
                    ::ptsname_r(controller.get(), name.data(), name.size()) == 0;
  if (!made)
    return fail("a pseudo-terminal cannot be made: " + std::string(std::strerror(errno)) +
                "; a mounted /dev/pts is wanted");
  return std::make_unique<PseudoTerminal>(std::move(controller), name.data());
}

}  // namespace orcart
