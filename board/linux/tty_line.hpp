// A serial line's settings through termios2, which knows every baud rate and not only the named ones.
#pragma once

#include "board/ports/byte_link.hpp"

namespace orcart {

/// Raw bytes, 8 data bits, no parity, one stop bit, modem lines ignored. On a pseudo-terminal the rate is
/// only a note.
Result<void, PortFault> set_tty_line(int fd, const LineSettings& line) noexcept;
/// Sends a break (a quarter to half a second). A pseudo-terminal carries none and says nothing of it.
Result<void, PortFault> send_tty_break(int fd) noexcept;
void discard_tty_input(int fd) noexcept;
/// Asks the driver for single bytes at once (FTDI: latency timer 1 ms) and locks others out; both where
/// possible.
void prepare_tty(int fd) noexcept;
/// The rate the line is set to; 0 where it cannot be told.
std::uint32_t tty_baud(int fd) noexcept;

}  // namespace orcart
