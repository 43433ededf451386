// Puts numbers and text into a reply.
#include "board/sim/ndi/wire_text.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "realtime/base/crc16.hpp"

namespace orcart {

void WireText::put(std::byte byte) noexcept {
  full_ = full_ || size_ == kCapacity;
  if (!full_) buffer_[size_++] = byte;
}

void WireText::text(std::string_view letters) noexcept {
  for (const char letter : letters) put(static_cast<std::byte>(letter));
}

void WireText::padded(std::string_view letters, std::size_t width) noexcept {
  for (std::size_t i = 0; i < width; ++i) {
    const bool printable = i < letters.size() && letters[i] >= ' ' && letters[i] <= '~';
    put(static_cast<std::byte>(printable ? letters[i] : ' '));
  }
}

void WireText::hex(std::uint32_t value, std::size_t digits) noexcept {
  for (std::size_t i = digits; i-- > 0;) {
    put(static_cast<std::byte>("0123456789ABCDEF"[value >> (4 * i) & 0xFu]));
  }
}

void WireText::signed_decimal(double value, std::size_t width) noexcept {
  const double largest = std::pow(10.0, static_cast<double>(width - 1)) - 1.0;
  auto left = static_cast<std::int64_t>(std::llround(std::min(std::abs(value), largest)));
  std::array<char, 12> digits{};
  for (std::size_t i = width; i-- > 1; left /= 10) digits[i] = static_cast<char>('0' + left % 10);
  digits[0] = value < 0 ? '-' : '+';
  text({digits.data(), width});
}

void WireText::decimal(std::int64_t value) noexcept {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void WireText::little_endian(std::uint32_t value, std::size_t size) noexcept {
  for (std::size_t i = 0; i < size; ++i) put(static_cast<std::byte>(value >> (8 * i) & 0xFFu));
}

void WireText::f32(double value) noexcept {
  u32(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void WireText::patch_u16(std::size_t at, std::uint32_t value) noexcept {
  for (std::size_t i = 0; i < 2 && at + i < size_; ++i) {
    buffer_[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xFFu);
  }
}

void WireText::patch_u32(std::size_t at, std::uint32_t value) noexcept {
  patch_u16(at, value & 0xFFFFu);
  patch_u16(at + 2, value >> 16);
}

void WireText::finish_text() noexcept {
  const std::uint16_t crc = crc16(bytes());
  hex(crc, 4);
  text("\r");
}

void WireText::finish_binary() noexcept {
  constexpr std::size_t kHeader = 6;
  const std::size_t length = size_;
  if (length + kHeader + 2 > kCapacity) {
    full_ = true;
    return;
  }
  std::copy_backward(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(length),
                     buffer_.begin() + static_cast<std::ptrdiff_t>(length + kHeader));
  size_ = length + kHeader;
  patch_u16(0, 0xA5C4);
  patch_u16(2, static_cast<std::uint32_t>(length));
  patch_u16(4, crc16(bytes().first(4)));
  u16(crc16(bytes().subspan(kHeader)));
}

}  // namespace orcart
