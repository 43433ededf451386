// A reply under construction: text or binary, in a buffer of fixed size, with the CRC put on at the end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace orcart {

/// What does not fit is left out and full() says so.
class WireText {
 public:
  static constexpr std::size_t kCapacity = 4096;

  void clear() noexcept { size_ = 0, full_ = false; }
  void text(std::string_view letters) noexcept;
  /// Padded with blanks, or cut, to `width`; blanks for what is not printable.
  void padded(std::string_view letters, std::size_t width) noexcept;
  void hex(std::uint32_t value, std::size_t digits) noexcept;
  /// A sign and `width` - 1 digits; a value that does not fit becomes the largest that does.
  void signed_decimal(double value, std::size_t width) noexcept;
  void decimal(std::int64_t value) noexcept;
  void u8(std::uint32_t value) noexcept { little_endian(value, 1); }
  void u16(std::uint32_t value) noexcept { little_endian(value, 2); }
  void u32(std::uint32_t value) noexcept { little_endian(value, 4); }
  void f32(double value) noexcept;
  /// Writes over two or four bytes that are already there.
  void patch_u16(std::size_t at, std::uint32_t value) noexcept;
  void patch_u32(std::size_t at, std::uint32_t value) noexcept;

  /// Puts CRC and carriage return behind the text.
  void finish_text() noexcept;
  /// Puts start sequence, length and header CRC in front of the body and the CRC behind it.
  void finish_binary() noexcept;

  std::span<std::byte> bytes() noexcept { return {buffer_.data(), size_}; }
  std::size_t size() const noexcept { return size_; }
  bool full() const noexcept { return full_; }

 private:
  void put(std::byte byte) noexcept;
  void little_endian(std::uint32_t value, std::size_t size) noexcept;

  std::array<std::byte, kCapacity> buffer_{};
  std::size_t size_ = 0;
  bool full_ = false;
};

}  // namespace orcart
