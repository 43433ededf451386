// Reads the fixed-width fields of an NDI text reply and never past its end.
#pragma once

#include <cstdint>
#include <string_view>

#include "firmware-host/tracker/ndi/hex.hpp"

namespace orcart::ndi {

/// Past the end, or at a letter that does not belong, every number is 0 and ok() says so.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) noexcept : rest_(text) {}

  std::uint32_t hex(std::size_t digits) noexcept {
    const auto value = parse_hex(take(digits));
    ok_ = ok_ && value.has_value();
    return value.value_or(0);
  }
  /// A sign and `digits` - 1 decimal digits.
  std::int32_t signed_decimal(std::size_t digits) noexcept {
    const std::string_view field = take(digits);
    ok_ = ok_ && field.size() >= 2 && (field[0] == '+' || field[0] == '-');
    if (!ok_) return 0;
    std::int32_t value = 0;
    for (const char letter : field.substr(1)) {
      ok_ = ok_ && letter >= '0' && letter <= '9';
      value = value * 10 + (letter - '0');
    }
    return field[0] == '-' ? -value : value;
  }
  /// Takes `word` where the text goes on with it.
  bool take_word(std::string_view word) noexcept {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  std::string_view take(std::size_t count) noexcept {
    ok_ = ok_ && count <= rest_.size();
    if (!ok_) return {};
    const std::string_view field = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return field;
  }
  /// Goes behind the next line feed.
  void skip_line() noexcept {
    const std::size_t end = rest_.find('\n');
    ok_ = ok_ && end != std::string_view::npos;
    if (ok_) rest_.remove_prefix(end + 1);
  }
  std::size_t left() const noexcept { return rest_.size(); }
  bool ok() const noexcept { return ok_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace orcart::ndi
