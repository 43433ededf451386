// What the emulated sensor says of itself: faults and alerts that stand, and those that nobody has asked for
// yet.
#pragma once

#include <cstdint>

#include "board/sim/ndi/wire_text.hpp"

namespace orcart {

/// Bits as GET:Info.Status.Alerts numbers them: faults from bit 0, alerts from bit 20.
class SelfReport {
 public:
  static constexpr std::uint32_t kBump = 1u << 21;

  void raise(std::uint32_t bits) noexcept {
    standing_ |= bits;
    unread_ |= bits;
  }
  /// As SET:Param.Simulated Alerts does: these and no others.
  void simulate(std::uint32_t bits) noexcept { standing_ = unread_ = bits; }
  void clear_bump() noexcept { standing_ &= ~kBump; }
  void read() noexcept { unread_ = 0; }

  std::uint32_t standing() const noexcept { return standing_; }
  std::uint32_t unread() const noexcept { return unread_; }
  bool bumped() const noexcept { return (standing_ & kBump) != 0; }
  std::uint32_t count() const noexcept;
  /// The items of a BX2 frame's component of alerts: kind, reserved, code.
  void put_items(WireText& reply) const noexcept;

 private:
  std::uint32_t standing_ = 0;
  std::uint32_t unread_ = 0;
};

}  // namespace orcart
