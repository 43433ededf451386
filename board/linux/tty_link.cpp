// Opens and closes the serial line; the rest is ByteStream's and tty_line's.
#include "board/linux/tty_link.hpp"

#include <fcntl.h>

#include <cerrno>

#include "board/linux/tty_line.hpp"

namespace orcart {
namespace {

std::string remedy(PortFault fault) {
  switch (fault) {
    case PortFault::no_permission:
      return "; a user in the group dialout would be let in";
    case PortFault::busy:
      return "; end the program that holds it";
    case PortFault::disconnected:
      return "; plug the tracker in, or name another device";
    case PortFault::unsupported:
      return "; a serial device such as /dev/ttyUSB0 would be accepted";
    default:
      return "";
  }
}

}  // namespace

Result<std::unique_ptr<TtyLink>> TtyLink::open(const std::string& device) {
  std::unique_ptr<TtyLink> link(new TtyLink(device));
  if (const auto opened = link->reopen(); !opened) {
    return fail("tracker device " + device + " cannot be opened: " + std::string(word_for(opened.error())) +
                remedy(opened.error()));
  }
  return link;
}

Result<void, PortFault> TtyLink::reopen() noexcept {
  stream_.close();
  FileDescriptor descriptor(::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!descriptor.valid()) return tl::unexpected(port_fault_of(errno));
  line_ = LineSettings{};
  if (const auto set = set_tty_line(descriptor.get(), line_); !set) return set;
  prepare_tty(descriptor.get());
  discard_tty_input(descriptor.get());
  stream_.adopt(std::move(descriptor));
  return {};
}

void TtyLink::discard_input() noexcept {
  if (stream_.is_open()) discard_tty_input(stream_.descriptor());
}

Result<void, PortFault> TtyLink::set_line(const LineSettings& line) noexcept {
  if (!stream_.is_open()) return tl::unexpected(PortFault::disconnected);
  line_ = line;
  return set_tty_line(stream_.descriptor(), line_);
}

Result<void, PortFault> TtyLink::send_break() noexcept {
  if (!stream_.is_open()) return tl::unexpected(PortFault::disconnected);
  return send_tty_break(stream_.descriptor());
}

}  // namespace orcart
