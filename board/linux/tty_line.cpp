// termios2, which does not go together with <termios.h> in one file.
#include "board/linux/tty_line.hpp"

#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include <cerrno>

#include "board/linux/byte_stream.hpp"

namespace orcart {

Result<void, PortFault> set_tty_line(int fd, const LineSettings& line) noexcept {
  termios2 settings{};
  if (::ioctl(fd, TCGETS2, &settings) != 0) return tl::unexpected(port_fault_of(errno));
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | BOTHER << IBSHIFT;
  if (line.flow == FlowControl::hardware) settings.c_cflag |= CRTSCTS;
  settings.c_ispeed = settings.c_ospeed = line.baud;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  // At once: the driver has waited for the last reply before it changes the rate.
  if (::ioctl(fd, TCSETS2, &settings) != 0) return tl::unexpected(port_fault_of(errno));
  return {};
}

Result<void, PortFault> send_tty_break(int fd) noexcept {
  if (::ioctl(fd, TCSBRK, 0) != 0) return tl::unexpected(port_fault_of(errno));
  return {};
}

void discard_tty_input(int fd) noexcept {
  ::ioctl(fd, TCFLSH, TCIFLUSH);
}

void prepare_tty(int fd) noexcept {
  ::ioctl(fd, TIOCEXCL);
  serial_struct serial{};
  if (::ioctl(fd, TIOCGSERIAL, &serial) != 0) return;
  serial.flags |= ASYNC_LOW_LATENCY;
  ::ioctl(fd, TIOCSSERIAL, &serial);
}

std::uint32_t tty_baud(int fd) noexcept {
  termios2 settings{};
  return ::ioctl(fd, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

}  // namespace orcart
