// Reads little-endian numbers from bytes and never past their end.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace orcart::ndi {

/// Past the end every number is 0 and ok() says so; look at ok() once, after reading.
class ByteCursor {
 public:
  explicit ByteCursor(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() noexcept { return number(4); }
  float f32() noexcept { return std::bit_cast<float>(number(4)); }
  void skip(std::size_t count) noexcept {
    ok_ = ok_ && count <= left();
    at_ = ok_ ? at_ + count : bytes_.size();
  }
  /// The next `count` bytes; empty where there are fewer.
  std::span<const std::byte> take(std::size_t count) noexcept {
    const std::size_t from = at_;
    skip(count);
    return ok_ ? bytes_.subspan(from, count) : std::span<const std::byte>{};
  }
  std::size_t left() const noexcept { return bytes_.size() - at_; }
  bool ok() const noexcept { return ok_; }

 private:
  std::uint32_t number(std::size_t size) noexcept {
    const std::size_t from = at_;
    skip(size);
    std::uint32_t value = 0;
    for (std::size_t i = 0; ok_ && i < size; ++i) {
      value |= std::to_integer<std::uint32_t>(bytes_[from + i]) << (8 * i);
    }
    return value;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace orcart::ndi
