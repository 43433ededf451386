// Keeps the kernel's console off the panel while pictures are shown, and gives it back.
#pragma once

#include <string>

#include "board/linux/device_calls.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Brings a virtual terminal to the front, in graphics mode and deaf to its keyboard; the one that was in
/// front comes back with its text when this ends. While it lasts, the kernel does not switch terminals: the
/// panel is a kiosk. After SIGKILL the terminal stays as it is; systemd's TTYReset gives it back.
class VirtualTerminal {
 public:
  static Result<VirtualTerminal> take(const std::string& tty, DeviceCalls& calls = system_calls());
  VirtualTerminal() = default;
  VirtualTerminal(VirtualTerminal&&) noexcept = default;
  VirtualTerminal& operator=(VirtualTerminal&&) noexcept = default;
  ~VirtualTerminal();

 private:
  OpenDevice terminal_;
  int keyboard_mode_ = 0, text_mode_ = 0;
  int front_before_ = 0;  ///< number of the terminal that was in front; 0: this one
};

}  // namespace orcart
