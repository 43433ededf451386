// KD and VT requests, in an order that can be undone at each step.
#include "board/linux/kms/virtual_terminal.hpp"

#include <fcntl.h>
#include <linux/kd.h>
#include <linux/vt.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>

#include "board/linux/byte_stream.hpp"

namespace orcart {
namespace {

void* number(int value) {
  return std::bit_cast<void*>(static_cast<std::intptr_t>(value));  // these requests take no pointer
}

int number_of(const std::string& tty) {
  const std::string prefix = "/dev/tty";
  int value = 0;
  if (!tty.starts_with(prefix)) return 0;
  const char* end = tty.data() + tty.size();
  const auto read = std::from_chars(tty.data() + prefix.size(), end, value);
  return read.ec == std::errc{} && read.ptr == end && value >= 1 && value <= 63 ? value : 0;
}

}  // namespace

Result<VirtualTerminal> VirtualTerminal::take(const std::string& tty, DeviceCalls& calls) {
  const int wanted = number_of(tty);
  if (wanted == 0)
    return fail("panel tty \"" + tty +
                "\" is no virtual terminal; /dev/tty1 to /dev/tty63 would be accepted");
  const auto refused = [&](int error) {
    const PortFault fault = port_fault_of(error);
    return fail("panel terminal " + tty + " cannot be had: " + std::string(word_for(fault)) +
                (fault == PortFault::no_permission
                     ? "; a service with TTYPath=" + tty + " (board/cart) owns it, or a user in the group tty"
                     : "; a free terminal such as /dev/tty7 would be accepted"));
  };
  const int fd = calls.open(tty.c_str(), O_RDWR | O_NOCTTY);
  if (fd < 0) return refused(-fd);
  VirtualTerminal taken;
  taken.terminal_ = OpenDevice(calls, fd);
  const OpenDevice& terminal = taken.terminal_;
  vt_stat state{};
  if (const int answer = terminal.control(VT_GETSTATE, &state); answer < 0) {
    taken.terminal_.reset();
    return refused(-answer);
  }
  const auto give_up = [&](int error) {
    taken.terminal_.reset();  // nothing was changed yet
    return refused(error);
  };
  if (const int answer = terminal.control(KDGETMODE, &taken.text_mode_); answer < 0) return give_up(-answer);
  if (const int answer = terminal.control(KDGKBMODE, &taken.keyboard_mode_); answer < 0)
    return give_up(-answer);
  taken.front_before_ = state.v_active == wanted ? 0 : state.v_active;
  if (taken.front_before_ != 0) {
    (void)terminal.control(VT_ACTIVATE, number(wanted));
    (void)terminal.control(VT_WAITACTIVE, number(wanted));
  }
  (void)terminal.control(KDSKBMODE, number(K_OFF));
  if (const int answer = terminal.control(KDSETMODE, number(KD_GRAPHICS)); answer < 0)
    return refused(-answer);
  return taken;
}

VirtualTerminal::~VirtualTerminal() {
  if (!terminal_.valid()) return;
  (void)terminal_.control(KDSETMODE, number(text_mode_));
  (void)terminal_.control(KDSKBMODE, number(keyboard_mode_));
  if (front_before_ != 0) (void)terminal_.control(VT_ACTIVATE, number(front_before_));
}

}  // namespace orcart
