// A pseudo-terminal as the emulated tracker's line.
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "board/linux/tty_line.hpp"
#include "realtime/kernel/clock.hpp"
#include "tools/emulate/emulator_port.hpp"

namespace orcart {
namespace {

constexpr Nanos kNobodyThere = 5ms;

struct Opened {
  FileDescriptor controller;
  std::string device;
};

/// Made for people, a new terminal echoes, which a tracker would take for commands and answer; and its
/// controller does not tell that nobody has it open before somebody had. The rate stays: 9600 would be news.
bool make_raw_and_leave(const char* device) {
  const FileDescriptor terminal(::open(device, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios line{};
  if (!terminal.valid() || ::tcgetattr(terminal.get(), &line) != 0) return false;
  line.c_iflag = line.c_oflag = line.c_lflag = 0;
  return ::tcsetattr(terminal.get(), TCSANOW, &line) == 0;
}

Result<Opened> open_controller() {
  FileDescriptor controller(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  const bool made =
      controller.valid() && ::grantpt(controller.get()) == 0 && ::unlockpt(controller.get()) == 0 &&
      ::ptsname_r(controller.get(), name.data(), name.size()) == 0 && make_raw_and_leave(name.data());
  if (!made)
    return fail("a pseudo-terminal cannot be made: " + std::string(std::strerror(errno)) +
                "; a mounted /dev/pts is wanted");
  return Opened{.controller = std::move(controller), .device = name.data()};
}

Result<void> point_link(const std::string& link, const std::string& device) {
  std::error_code error;
  if (std::filesystem::is_symlink(link, error)) std::filesystem::remove(link, error);
  std::filesystem::create_symlink(device, link, error);
  if (error) {
    return fail("link " + link + " cannot be made (" + error.message() +
                "); a name that is free, or a symbolic link, in a writable folder would be accepted");
  }
  return {};
}

class PseudoTerminal final : public EmulatorPort {
 public:
  PseudoTerminal(Opened opened, std::string link) noexcept
      : controller_(std::move(opened.controller)),
        device_(std::move(opened.device)),
        link_(std::move(link)) {}
  ~PseudoTerminal() override { remove_link(); }

  const std::string& name() const override { return link_.empty() ? device_ : link_; }

  void wait(Nanos time) override {
    if (!controller_.valid())
      return RealClock{}.sleep_until(RealClock{}.now() + std::min(time, kNobodyThere));
    const timespec timeout{.tv_sec = time / 1s, .tv_nsec = (time % 1s).count()};
    pollfd watched{.fd = controller_.get(), .events = POLLIN, .revents = 0};
    ::ppoll(&watched, 1, &timeout, nullptr);
    nobody_there_ = (watched.revents & POLLHUP) != 0;
    if (nobody_there_) RealClock{}.sleep_until(RealClock{}.now() + kNobodyThere);
  }
  std::size_t read(std::span<std::byte> into) override {
    const ssize_t count = controller_.valid() ? ::read(controller_.get(), into.data(), into.size()) : 0;
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  void write(std::span<const std::byte> bytes) override {
    // What a client does not read is lost, as on a line without flow control.
    if (!nobody_there_) (void)!::write(controller_.get(), bytes.data(), bytes.size());
  }
  std::uint32_t baud() override { return nobody_there_ ? 0 : tty_baud(controller_.get()); }
  void cut() override {
    controller_.reset();
    nobody_there_ = true;
    remove_link();
  }
  void mend() override {
    if (controller_.valid()) return;
    auto opened = open_controller();
    if (!opened) return;  // tried again at the next turn
    if (!link_.empty() && !point_link(link_, opened->device)) return;
    controller_ = std::move(opened->controller);
    device_ = std::move(opened->device);
  }

 private:
  void remove_link() {
    std::error_code error;
    if (!link_.empty() && std::filesystem::is_symlink(link_, error)) std::filesystem::remove(link_, error);
  }

  FileDescriptor controller_;
  std::string device_;
  std::string link_;
  bool nobody_there_ = true;
};

}  // namespace

Result<std::unique_ptr<EmulatorPort>> open_pseudo_terminal(const std::string& link) {
  auto opened = open_controller();
  if (!opened) return tl::unexpected(opened.error());
  if (!link.empty()) {
    if (auto pointed = point_link(link, opened->device); !pointed) return tl::unexpected(pointed.error());
  }
  return std::make_unique<PseudoTerminal>(std::move(*opened), link);
}

}  // namespace orcart
