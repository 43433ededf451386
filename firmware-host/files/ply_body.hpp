// The numbers behind a PLY header, one by one, in any of the three encodings.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

#include "firmware-host/files/ply_header.hpp"
#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

/// Never reads beyond the file; gives nothing at its end or where a word is no number.
class PlyBody {
 public:
  PlyBody(std::string_view body, PlyEncoding encoding)
      : body_(body), encoding_(encoding), text_(encoding == PlyEncoding::ascii ? body : std::string_view{}) {}

  std::size_t left() const {
    return encoding_ == PlyEncoding::ascii ? body_.size() - text_.place() : body_.size() - at_;
  }
  std::size_t line_number() const { return text_.line_number(); }
  bool ascii() const { return encoding_ == PlyEncoding::ascii; }

  std::optional<double> next(PlyScalar type) {
    if (encoding_ == PlyEncoding::ascii) return text_.number<double>();
    switch (type) {
      case PlyScalar::i8:
        return take<std::int8_t>();
      case PlyScalar::u8:
        return take<std::uint8_t>();
      case PlyScalar::i16:
        return take<std::int16_t>();
      case PlyScalar::u16:
        return take<std::uint16_t>();
      case PlyScalar::i32:
        return take<std::int32_t>();
      case PlyScalar::u32:
        return take<std::uint32_t>();
      case PlyScalar::f32:
        return take<float>();
      case PlyScalar::f64:
        return take<double>();
    }
    return std::nullopt;
  }

 private:
  template <class Number>
  std::optional<double> take() {
    std::array<char, sizeof(Number)> raw{};
    if (body_.size() - at_ < raw.size()) return std::nullopt;
    std::memcpy(raw.data(), body_.data() + at_, raw.size());
    at_ += raw.size();
    if ((encoding_ == PlyEncoding::big) == (std::endian::native == std::endian::little))
      std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

  std::string_view body_;
  PlyEncoding encoding_;
  TextCursor text_;
  std::size_t at_ = 0;
};

}  // namespace orcart
