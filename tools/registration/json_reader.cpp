// A recursive descent with a bound on its depth.
#include "tools/registration/json_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace orcart {
namespace {

void append_utf8(std::uint32_t point, std::string& out) {
  const auto tail = [&](unsigned shift) { out += static_cast<char>(0x80U | ((point >> shift) & 0x3FU)); };
  if (point < 0x80) {
    out += static_cast<char>(point);
  } else if (point < 0x800) {
    out += static_cast<char>(0xC0U | (point >> 6U));
    tail(0);
  } else if (point < 0x10000) {
    out += static_cast<char>(0xE0U | (point >> 12U));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xF0U | ((point >> 18U) & 7U));
    tail(12);
    tail(6);
    tail(0);
  }
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool value(JsonValue& out, int depth) {
    skip();
    if (depth > 64 || at_ >= text_.size()) return false;
    const char c = text_[at_];
    if (c == '{' || c == '[') return container(out, c == '{', depth);
    if (c == '"') return string(out.text);
    for (const auto& [word, number] : {std::pair{"true", 1.0}, {"false", 0.0}, {"null", 0.0}})
      if (text_.substr(at_).starts_with(word)) {
        out.number = number;
        at_ += std::string_view(word).size();
        return true;
      }
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), out.number);
    at_ = static_cast<std::size_t>(end - text_.data());
    return error == std::errc{};
  }

  bool at_end() {
    skip();
    return at_ == text_.size();
  }

 private:
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool string(std::string& out) {
    if (!take('"')) return false;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        return true;
      }
      if (text_[at_] == '\\' && at_ + 1 < text_.size())
        escaped(out);
      else
        out += text_[at_];
    }
    return false;
  }

  /// The four digits of a \u behind `at_`, where they are four; moves onto the last of them.
  std::optional<std::uint32_t> unit() {
    std::uint32_t value = 0;
    const std::string_view digits = text_.substr(std::min(at_ + 1, text_.size()), 4);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || digits.size() != 4 || end != digits.data() + 4) return std::nullopt;
    at_ += 4;
    return value;
  }

  /// What stands behind a backslash at `at_`; moves onto its last character.
  void escaped(std::string& out) {
    const char c = text_[++at_];
    constexpr std::string_view kLetters = "bfnrt", kMeant = "\b\f\n\r\t";
    const auto letter = kLetters.find(c);
    const auto first = c == 'u' ? unit() : std::nullopt;
    if (!first) {
      out += letter == std::string_view::npos ? c : kMeant[letter];
      return;
    }
    std::uint32_t point = *first;
    if (point >= 0xD800 && point < 0xDC00 && text_.substr(at_ + 1).starts_with("\\u")) {
      at_ += 2;
      if (const auto second = unit())
        point = 0x10000 + ((point - 0xD800) << 10U) + ((*second - 0xDC00) & 0x3FFU);
    }
    append_utf8(point, out);
  }

  bool container(JsonValue& out, bool object, int depth) {
    ++at_;
    const char close = object ? '}' : ']';
    if (take(close)) return true;
    do {
      if (object) {
        skip();
        if (!string(out.names.emplace_back()) || !take(':')) return false;
      }
      if (!value(out.items.emplace_back(), depth + 1)) return false;
    } while (take(','));
    return take(close);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<JsonValue> read_json(std::string_view text) {
  Reader reader(text);
  JsonValue value;
  if (!reader.value(value, 0) || !reader.at_end()) return std::nullopt;
  return value;
}

}  // namespace orcart
