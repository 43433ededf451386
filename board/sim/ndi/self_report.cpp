// Bits of the parameter, as kinds and codes of BX2.
#include "board/sim/ndi/self_report.hpp"

#include <array>
#include <bit>

namespace orcart {
namespace {

constexpr int kFirstAlertBit = 20;
/// BX2's code of each alert from bit 20 on; 0 where there is none.
constexpr std::array<std::uint8_t, 12> kAlertCodes{1, 2, 10, 3, 4, 5, 6, 0, 0, 8, 9, 0};

std::uint32_t known(std::uint32_t bits) noexcept {
  for (int bit = kFirstAlertBit; bit < 32; ++bit) {
    if (kAlertCodes[static_cast<std::size_t>(bit - kFirstAlertBit)] == 0) bits &= ~(1u << bit);
  }
  return bits;
}

}  // namespace

std::uint32_t SelfReport::count() const noexcept {
  return static_cast<std::uint32_t>(std::popcount(known(standing_)));
}

void SelfReport::put_items(WireText& reply) const noexcept {
  for (int bit = 0; bit < 32; ++bit) {
    if ((known(standing_) >> bit & 1u) == 0) continue;
    const bool alert = bit >= kFirstAlertBit;
    reply.u8(alert ? 1 : 0);
    reply.u8(0);
    reply.u16(alert ? kAlertCodes[static_cast<std::size_t>(bit - kFirstAlertBit)]
                    : static_cast<std::uint32_t>(bit) + 1);
  }
}

}  // namespace orcart
